#include "core/ranks.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>

namespace simwright::core {
namespace {

constexpr int kMostRanks = 1 << 24;

std::optional<int> NumberIn(const char* text) {
  if (text == nullptr || *text == '\0') return std::nullopt;
  char* end = nullptr;
  const long number = std::strtol(text, &end, 10);
  if (*end != '\0' || number < 0 || number > kMostRanks) return std::nullopt;
  return static_cast<int>(number);
}

// Returns the number of tasks on a machine from Slurm's list, "2(x3),1": two on each of the first
// three machines, one on the fourth.
std::optional<int> TasksOnMachine(const char* list, int machine) {
  if (list == nullptr) return std::nullopt;
  const std::string text(list);
  for (size_t from = 0; from < text.size();) {
    const size_t comma = std::min(text.find(',', from), text.size());
    const std::string item = text.substr(from, comma - from);
    const size_t times = item.find("(x");
    const auto tasks = NumberIn(item.substr(0, times).c_str());
    int machines = 1;
    if (times != std::string::npos && item.back() == ')') {
      machines = NumberIn(item.substr(times + 2, item.size() - times - 3).c_str()).value_or(1);
    }
    if (machine < machines) return tasks;
    machine -= machines;
    from = comma + 1;
  }
  return std::nullopt;
}

// Takes rank and number of ranks from two variables; false where they are not set or contradict.
bool TakeRanks(const VariableReader& variable, const char* rank, const char* size,
               RankPlace* place) {
  const auto number = NumberIn(variable(rank)), count = NumberIn(variable(size));
  if (!number || !count || *number >= *count) return false;
  place->rank = *number;
  place->world_size = *count;
  return true;
}

void TakeLauncher(const VariableReader& variable, RankPlace* place) {
  std::optional<int> here;
  if (TakeRanks(variable, "OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", place)) {
    here = NumberIn(variable("OMPI_COMM_WORLD_LOCAL_SIZE"));
  } else if (TakeRanks(variable, "PMI_RANK", "PMI_SIZE", place)) {
    here = NumberIn(variable("MPI_LOCALNRANKS"));
  } else if (TakeRanks(variable, "SLURM_PROCID", "SLURM_STEP_NUM_TASKS", place)) {
    // srun alone sets the number of a step's tasks, a batch script has none.
    here = TasksOnMachine(variable("SLURM_STEP_TASKS_PER_NODE"),
                          NumberIn(variable("SLURM_NODEID")).value_or(0));
  } else {
    return;
  }
  place->local_world_size = std::clamp(here.value_or(place->world_size), 1, place->world_size);
}

void TakeArray(const VariableReader& variable, RankPlace* place) {
  const auto id = NumberIn(variable("SLURM_ARRAY_TASK_ID"));
  if (!id) return;
  const auto first = NumberIn(variable("SLURM_ARRAY_TASK_MIN"));
  const auto step = NumberIn(variable("SLURM_ARRAY_TASK_STEP"));
  const auto count = NumberIn(variable("SLURM_ARRAY_TASK_COUNT"));
  place->array_tasks = std::max(1, count.value_or(1));
  // An array may be a list without a constant step: any number below the count will do.
  place->array_task =
      std::max(0, *id - first.value_or(0)) / std::max(1, step.value_or(1)) % place->array_tasks;
}

}  // namespace

RankPlace PlaceOf(const VariableReader& variable) {
  RankPlace place;
  TakeLauncher(variable, &place);
  TakeArray(variable, &place);
  place.processors_per_rank = NumberIn(variable("SLURM_CPUS_PER_TASK")).value_or(0);
  place.processors_of_machine = NumberIn(variable("SLURM_CPUS_ON_NODE")).value_or(0);
  return place;
}

const RankPlace& ThisRank() {
  static const RankPlace place = PlaceOf([](const char* name) { return std::getenv(name); });
  return place;
}

int ThreadsOf(const RankPlace& place, int allowed, int of_launcher) {
  int machine = std::max(allowed, of_launcher);
  if (place.processors_of_machine > 0) machine = std::min(machine, place.processors_of_machine);
  int threads = std::min(allowed, machine / place.local_world_size);
  if (place.processors_per_rank > 0) threads = std::min(threads, place.processors_per_rank);
  return std::max(1, threads);
}

}  // namespace simwright::core
