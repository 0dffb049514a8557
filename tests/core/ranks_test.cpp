// The place of a process among its ranks, from the variables that launchers document.
#include "core/ranks.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace simwright::core {
namespace {

using Variables = std::map<std::string, std::string>;

RankPlace With(const Variables& variables) {
  return PlaceOf([&](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  });
}

TEST(RankPlace, IsAloneWithoutALauncher) {
  const RankPlace alone = With({});
  EXPECT_EQ(alone.world_size, 1);
  EXPECT_EQ(alone.workers(), 1);
  EXPECT_TRUE(alone.leads());
  // A batch script itself is no rank, whatever its job allocates.
  EXPECT_EQ(With({{"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "8"}}).world_size, 1);
  // Contradictions count as unset.
  EXPECT_EQ(With({{"PMI_RANK", "4"}, {"PMI_SIZE", "4"}}).world_size, 1);
  EXPECT_EQ(With({{"PMI_RANK", "one"}, {"PMI_SIZE", "4"}}).world_size, 1);
}

TEST(RankPlace, IsReadFromEachLauncher) {
  const RankPlace open_mpi = With({{"OMPI_COMM_WORLD_RANK", "5"},
                                   {"OMPI_COMM_WORLD_SIZE", "8"},
                                   {"OMPI_COMM_WORLD_LOCAL_SIZE", "4"}});
  EXPECT_EQ(open_mpi.rank, 5);
  EXPECT_EQ(open_mpi.world_size, 8);
  EXPECT_EQ(open_mpi.local_world_size, 4);
  EXPECT_FALSE(open_mpi.leads());
  const RankPlace hydra = With({{"PMI_RANK", "0"}, {"PMI_SIZE", "6"}, {"MPI_LOCALNRANKS", "2"}});
  EXPECT_EQ(hydra.world_size, 6);
  EXPECT_EQ(hydra.local_world_size, 2);
  EXPECT_TRUE(hydra.leads());
  const auto srun = [](const char* machine) {
    return With({{"SLURM_PROCID", "6"},
                 {"SLURM_STEP_NUM_TASKS", "7"},
                 {"SLURM_STEP_TASKS_PER_NODE", "2(x3),1"},
                 {"SLURM_NODEID", machine}})
        .local_world_size;
  };
  EXPECT_EQ(srun("0"), 2);
  EXPECT_EQ(srun("2"), 2);
  EXPECT_EQ(srun("3"), 1);
}

TEST(RankPlace, CountsTheTasksOfAnArray) {
  const Variables array = {{"SLURM_ARRAY_TASK_ID", "30"},
                           {"SLURM_ARRAY_TASK_MIN", "10"},
                           {"SLURM_ARRAY_TASK_STEP", "5"},
                           {"SLURM_ARRAY_TASK_COUNT", "8"}};
  RankPlace place = With(array);
  EXPECT_EQ(place.array_task, 4);
  EXPECT_EQ(place.workers(), 8);
  EXPECT_EQ(place.worker(), 4);
  EXPECT_TRUE(place.leads());
  // Two ranks in each task.
  Variables both = array;
  both.insert({{"OMPI_COMM_WORLD_RANK", "1"}, {"OMPI_COMM_WORLD_SIZE", "2"}});
  place = With(both);
  EXPECT_EQ(place.workers(), 16);
  EXPECT_EQ(place.worker(), 9);
  EXPECT_FALSE(place.leads());
}

TEST(ThreadsOf, SharesAMachineAmongItsRanks) {
  RankPlace place;
  EXPECT_EQ(ThreadsOf(place, 8, 8), 8);
  EXPECT_EQ(ThreadsOf(place, 1, 8), 1);  // taskset
  place.world_size = place.local_world_size = 4;
  EXPECT_EQ(ThreadsOf(place, 8, 8), 2);  // not bound
  EXPECT_EQ(ThreadsOf(place, 2, 8), 2);  // each bound to its own two
  EXPECT_EQ(ThreadsOf(place, 4, 8), 2);  // two of them bound to each socket
  EXPECT_EQ(ThreadsOf(place, 2, 2), 1);  // more ranks than processors
  place.processors_of_machine = 16;      // Slurm's job has 16 of the machine's 64
  EXPECT_EQ(ThreadsOf(place, 16, 64), 4);
  place.processors_per_rank = 3;
  EXPECT_EQ(ThreadsOf(place, 16, 64), 3);
}

}  // namespace
}  // namespace simwright::core
