#include "workflows/skills/skill_suite.h"

#include <algorithm>

#include "core/error.h"
#include "tasks/task_file.h"
#include "workflows/library/library.h"
#include "workflows/lift/lift.h"
#include "workflows/skills/skill_run.h"
#include "workflows/tasks/task_making.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPhoto = "photo";
constexpr const char* kPhotoCategory = "coffee cup";
// Enough for every joint of every instance to have its tasks.
constexpr int kTasksPerInstance = 60;

void MakeInstances(const SuiteCell& cell, std::uint64_t seed, int count, const fs::path& photo,
                   const fs::path& folder, core::Progress* progress) {
  if (cell.kind == kPhoto) {
    LiftRequest request;
    request.photo = photo;
    const fs::path mask = fs::path(photo).replace_filename(photo.stem().string() + "_mask.png");
    if (fs::exists(mask)) request.mask = mask;
    request.category = kPhotoCategory;
    request.effort = asset_lift::LiftEffort::kFast;
    request.output = folder / "photo_cup";
    LiftToFolder(request, progress);
    return;
  }
  LibraryOptions options;
  options.kind = cell.kind;
  options.count = count;
  options.seed = seed;
  options.check = false;  // the library's own tests check every kind
  MakeLibrary(options, folder, progress);
}

}  // namespace

const std::vector<SuiteCell>& SkillSuite() {
  static const std::vector<SuiteCell> suite = {
      {"open_microwave_door", "microwave", "open_microwave_*_door", "open", "door", "microwave",
       "open the door of a microwave"},
      {"close_microwave_door", "microwave", "close_microwave_*_door", "close", "door", "microwave",
       "close the door of a microwave"},
      {"open_drawer", "drawer_unit", "open_drawer_unit_*_drawer_*", "open", "drawer",
       "chest of drawers", "open a drawer of a chest"},
      {"close_drawer", "drawer_unit", "close_drawer_unit_*_drawer_*", "close", "drawer",
       "chest of drawers", "close a drawer of a chest"},
      {"open_cabinet_door", "cabinet", "open_cabinet_*_door_*", "open", "door", "cabinet",
       "open a door of a cabinet", 0, 30, "panda_on_base"},
      {"close_cabinet_door", "cabinet", "close_cabinet_*_door_*", "close", "door", "cabinet",
       "close a door of a cabinet", 0, 30, "panda_on_base"},
      {"turn_faucet_knob", "faucet", "turn_on_faucet_*_knob_*", "turn_on", "knob", "faucet",
       "turn on a knob of a faucet"},
      {"press_toaster_lever", "toaster", "press_toaster_*_lever", "press", "lever", "toaster",
       "press the lever of a toaster"},
      {"lift_lid", "box_with_lid", "open_box_with_lid_*_lid", "open", "lid", "box",
       "open the hinged lid of a box", 0, 30},
      {"push_box", "tissue_box", "push_tissue_box_*", "push", "", "tissue box",
       "push a box along the floor", 0, 30},
      {"pick_up_cup", "cup", "pick_up_cup_*", "pick_up", "", "cup", "pick up a cup"},
      {"put_down_cup", "cup", "move_cup_*", "put_down", "", "cup", "put a held cup down at a goal",
       1},
      {"pick_up_photo", kPhoto, "pick_up_photo_cup", "pick_up", "", kPhotoCategory,
       "pick up a cup that was reconstructed from a photo"},
  };
  return suite;
}

const SuiteCell& CellOf(const std::string& name) {
  std::string names;
  for (const SuiteCell& cell : SkillSuite()) {
    if (cell.name == name) return cell;
    names += (names.empty() ? "" : ", ") + cell.name;
  }
  throw core::Error("there is no cell '" + name + "'", "the suite", "it has " + names);
}

skills::ActionSpace ActionSpaceOf(const rl::Policy& policy) {
  const auto fact = policy.metadata().find("action");
  return fact == policy.metadata().end() ? skills::ActionSpace::kTargetFrame
                                         : skills::ActionSpaceOf(fact->second);
}

fs::path ShippedPolicy(const fs::path& models, const std::string& cell) {
  return models / "skills" / (cell + ".pt");
}

fs::path MakeCellTasks(const SuiteCell& cell, std::uint64_t seed, int count, const fs::path& photo,
                       const fs::path& folder, core::Progress* progress) {
  const fs::path file = folder / "tasks.json";
  if (fs::exists(file)) return file;
  fs::create_directories(folder);
  const fs::path assets = folder / "assets";
  fs::remove_all(assets);  // leftovers of an interrupted run
  MakeInstances(cell, seed, count, photo, assets, progress);
  TasksRequest request;
  request.assets = {assets.string()};
  request.output = folder / "all_tasks.json";
  request.count = kTasksPerInstance * count;
  request.force = true;
  tasks::TaskSet set =
      ChooseTasks(MakeTasks(request, progress).set, {cell.pattern}, request.output.string());
  for (tasks::Task& task : set.tasks) {
    const auto index = static_cast<size_t>(cell.subtask);
    if (index >= task.subtasks.size()) {
      throw core::Error("has no subtask " + std::to_string(index + 1), task.name);
    }
    task.subtasks = {task.subtasks[index]};
  }
  tasks::WriteTaskFile(set, file);
  return file;
}

}  // namespace simwright::workflows
