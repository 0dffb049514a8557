// Measures the seconds to read assets and to generate verified tasks for them, by rules.
//   bench_task_speed ASSET... [--count N] [--threads N]
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "tasks/rules/rule_tasks.h"
#include "workflows/tasks/task_assets.h"

namespace simwright {
namespace {

using Clock = std::chrono::steady_clock;

double Seconds(Clock::time_point since) {
  return std::chrono::duration<double>(Clock::now() - since).count();
}

int Run(const std::vector<std::string>& arguments, int count) {
  Clock::time_point start = Clock::now();
  const workflows::TaskAssets assets = workflows::ReadTaskAssets(arguments);
  std::printf("%zu assets read in %.2f s\n", assets.models.size(), Seconds(start));
  start = Clock::now();
  const tasks::WorldModel model = tasks::MakeWorldModel(assets.models);
  std::printf("their receptacles and hull points in %.2f s\n", Seconds(start));
  start = Clock::now();
  const tasks::RuleTasks made = tasks::GenerateTasksByRules(model, {count, 1});
  const double seconds = Seconds(start);
  std::size_t subtasks = 0, longer = 0;
  std::set<std::string> articulated, rigid;
  for (const tasks::Task& task : made.tasks) {
    subtasks += task.subtasks.size();
    longer += task.subtasks.size() >= 2;
    for (const std::string& name : task.assets) {
      const tasks::ArticulatedObject& object =
          model.objects[static_cast<std::size_t>(model.Find(name))];
      (object.articulated() ? articulated : rigid).insert(object.category);
    }
  }
  std::printf("%zu tasks of %zu subtasks in %.2f s, %.1f ms per subtask, on %d threads\n",
              made.tasks.size(), subtasks, seconds, 1e3 * seconds / static_cast<double>(subtasks),
              core::ThreadCount());
  std::printf("%zu of two or more subtasks; %zu articulated and %zu rigid categories\n", longer,
              articulated.size(), rigid.size());
  return 0;
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  std::vector<std::string> assets;
  int count = 0;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--count" && i + 1 < argc) {
      count = std::atoi(argv[++i]);
    } else if (argument == "--threads" && i + 1 < argc) {
      simwright::core::SetThreadCount(std::atoi(argv[++i]));
    } else {
      assets.push_back(argument);
    }
  }
  try {
    return simwright::Run(assets, count);
  } catch (const simwright::core::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
