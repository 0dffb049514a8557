#pragma once

#include <functional>

namespace simwright::core {

// The place of this process among those that one command line started: the ranks of mpirun or srun,
// and the tasks of a Slurm array. Named as in PyTorch's distributed package.
struct RankPlace {
  int rank = 0, world_size = 1;         // among the ranks of mpirun or srun
  int local_world_size = 1;             // the ranks on this machine
  int array_task = 0, array_tasks = 1;  // among the tasks of a Slurm array, counted from 0
  int processors_per_rank = 0;          // of Slurm; 0: unknown
  int processors_of_machine = 0;        // of Slurm's job on this machine; 0: unknown

  // Returns true for the rank that prints and reports for all ranks.
  bool leads() const { return rank == 0; }
  // The number of processes that share the work, and the number of this one.
  int workers() const { return world_size * array_tasks; }
  int worker() const { return array_task * world_size + rank; }
};

// Returns the value of an environment variable, or null.
using VariableReader = std::function<const char*(const char* name)>;

// Reads the place from the variables that Open MPI, launchers with Hydra (MPICH, Intel MPI), srun
// and sbatch --array set. A variable that is missing or no number counts as unset.
RankPlace PlaceOf(const VariableReader& variable);

// Returns the place of this process, read once from its environment.
const RankPlace& ThisRank();

// Returns the number of threads of a rank, >= 1: the ranks of a machine share its processors.
// `allowed`: the processors that this process may use; `of_launcher`: those that its parent may
// use, which are more where the launcher bound each rank to its own.
int ThreadsOf(const RankPlace& place, int allowed, int of_launcher);

}  // namespace simwright::core
