#include "factory/factory_tasks.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "factory/factory_asset.h"
#include "tasks/task_file.h"
#include "workflows/tasks/task_making.h"

namespace simwright::factory {
namespace fs = std::filesystem;

int AskedTasks(const FactoryPlan& plan, int part) {
  return std::min(plan.tasks_per_part, plan.tasks - part * plan.tasks_per_part);
}

TaskPartRecord MakeTaskPart(const FactoryPlan& plan, int part, int asked,
                            const FactoryFolder& folder) {
  const auto start = std::chrono::steady_clock::now();
  const double before = ThreadSeconds();
  TaskPartRecord record;
  record.part = part;
  record.asked = asked;
  workflows::TasksRequest request;
  for (const int index : ItemsOfPart(plan, part)) {
    const std::string& name = plan.items[static_cast<size_t>(index)].name;
    const auto made = ReadAssetRecord(folder.asset_record(name));
    if (!made || !made->made()) continue;
    record.assets.push_back(name);
    request.assets.push_back((folder.assets() / name).string());
  }
  request.output = folder.task_part(part);
  request.count = record.asked;
  request.seed = plan.seed + static_cast<std::uint64_t>(part);
  request.force = true;
  fs::create_directories(request.output.parent_path());
  if (request.assets.empty()) {
    record.reason = "none of its assets was made";
  } else {
    try {
      core::Progress silent;
      workflows::TasksReport report = workflows::MakeTasks(request, &silent);
      std::erase_if(report.set.tasks, [](const tasks::Task& task) { return !task.valid(); });
      tasks::WriteTaskFile(report.set, request.output);
      record.made = static_cast<int>(report.set.tasks.size());
      if (record.made < record.asked) {
        record.reason = "its assets give no more tasks that pass verification";
      }
    } catch (const core::Error& error) {
      record.reason = error.what();
    }
  }
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  record.cpu_seconds = ThreadSeconds() - before;
  return record;
}

int JoinTaskParts(int parts, const FactoryFolder& folder) {
  tasks::TaskSet joined;
  std::set<std::string> assets, names;
  for (int part = 0; part < parts; ++part) {
    const fs::path file = folder.task_part(part);
    const auto record = ReadTaskPart(folder.task_record(part));
    if (!record || record->made == 0 || !fs::exists(file)) continue;
    tasks::TaskSet set = tasks::ReadTaskFile(file);
    for (tasks::TaskAsset& asset : set.assets) {
      if (assets.insert(asset.name).second) joined.assets.push_back(std::move(asset));
    }
    for (tasks::Task& task : set.tasks) {
      std::string name = task.name;
      for (int k = 2; !names.insert(name).second; ++k) name = task.name + "_" + std::to_string(k);
      task.name = name;
      joined.tasks.push_back(std::move(task));
    }
  }
  if (joined.tasks.empty()) return 0;
  tasks::WriteTaskFile(joined, folder.tasks());
  return static_cast<int>(joined.tasks.size());
}

}  // namespace simwright::factory
