#include "workflows/tasks/long_tasks.h"

#include <algorithm>
#include <sstream>

#include "core/error.h"
#include "skills/variant_reward.h"
#include "tasks/task_file.h"
#include "workflows/library/library.h"
#include "workflows/tasks/task_making.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr int kLongTasks = 60;  // enough for the rules to generate every kind of task

}  // namespace

const std::vector<LongTask>& LongTasks() {
  static const std::vector<LongTask> tasks = {
      {"cup_into_microwave", "microwave,cup", "put_cup_*_into_microwave_*_and_close_it"},
      // The shortest task of several subtasks: short enough for PPO without a script.
      {"cup_to_goal", "cup", "move_cup_*"},
      {"apple_into_drawer", "drawer_unit,apple", "put_apple_*_into_drawer_unit_*_and_close_it"},
      // A cabinet with one door: with two, an object in the middle is half behind the other door.
      {"cup_out_of_cabinet", "cabinet,cup", "take_cup_*_out_of_cabinet_*", "panda_on_base", 302},
  };
  return tasks;
}

const LongTask& LongTaskOf(const std::string& name) {
  std::string names;
  for (const LongTask& task : LongTasks()) {
    if (task.name == name) return task;
    names += (names.empty() ? "" : ", ") + task.name;
  }
  throw core::Error("there is no long task '" + name + "'", "", "known ones are " + names);
}

fs::path MakeLongTask(const LongTask& task, const fs::path& folder, core::Progress* progress) {
  const fs::path file = folder / "tasks.json";
  if (fs::exists(file)) return file;
  const fs::path assets = folder / "assets";
  fs::remove_all(assets);  // leftovers of an interrupted run
  std::istringstream kinds(task.kinds);
  for (std::string kind; std::getline(kinds, kind, ',');) {
    LibraryOptions options;
    options.kind = kind;
    options.count = 1;
    options.seed = task.seed;
    options.check = false;  // the library's own tests check every kind
    MakeLibrary(options, assets / kind, progress);
  }
  TasksRequest request;
  for (const auto& kind : fs::directory_iterator(assets)) {
    request.assets.push_back(kind.path().string());
  }
  request.output = folder / "all_tasks.json";
  request.count = kLongTasks;
  request.force = true;
  tasks::TaskSet set =
      ChooseTasks(MakeTasks(request, progress).set, {task.task}, request.output.string());
  set.tasks.resize(1);
  tasks::WriteTaskFile(set, file);
  return file;
}

std::vector<bool> LastingSubtasks(const std::vector<RunSkill>& skills,
                                  const skills::ChainEvaluation& chain) {
  std::vector<bool> lasting;
  for (const RunSkill& skill : skills) {
    int held = 0, seen = 0;
    for (const skills::ChainOutcome& outcome : chain.outcomes) {
      if (!outcome.success) continue;
      const skills::StartState& end = outcome.links.back().end;
      const skills::SkillVariant& variant = skill.skill->variants[static_cast<size_t>(end.variant)];
      tasks::WorldState state = end.state;
      state.goal = variant.start.goal;
      bool success = false;
      skills::VariantReward(variant).Run(state, state, 1.0, &success);
      held += success;
      ++seen;
    }
    lasting.push_back(seen > 0 && 2 * held > seen);
  }
  if (std::find(lasting.begin(), lasting.end(), true) == lasting.end()) lasting.back() = true;
  return lasting;
}

}  // namespace simwright::workflows
