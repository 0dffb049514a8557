#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "rl/policy.h"
#include "skills/skill_options.h"
#include "tasks/task.h"

namespace simwright::workflows {

// One skill of the suite that demonstrates the benefit of training: a subtask, on library kinds.
struct SuiteCell {
  std::string name;     // open_microwave_door
  std::string kind;     // a library kind; "photo": the cup reconstructed from the example photo
  std::string pattern;  // selects the tasks that contain the subtask (ChooseTasks)
  // The name of the subtask is the verb, the asset's name and the part, joined by '_':
  // "open_microwave_1_door". The part is empty if the whole object is moved.
  std::string verb, part;
  std::string category;     // the category of the kind's assets in tasks.json
  std::string description;  // what the skill does: "open a microwave's door"
  int subtask = 0;          // the subtask's index in those tasks
  double minutes = 10;      // the maximum training time on two cores
  // Cabinets are as high as the robot and their open doors stand beside it, which requires a base.
  std::string robot = "panda";
  int instances = 32;  // training instances of the kind; 8 do not generalise as well
};

// Seeds of the instances: training and evaluation use different instances of the kind, with seeds
// from 1 on and from 301 on; kUnseenInstances is the number of evaluation instances.
constexpr std::uint64_t kSeenSeed = 1, kUnseenSeed = 301;
constexpr int kUnseenInstances = 8;

const std::vector<SuiteCell>& SkillSuite();

// Returns the cell of this name. Throws core::Error, listing the known names, if there is none.
const SuiteCell& CellOf(const std::string& name);

// Returns the policy's action space: its fact `action`, else "focus", the action space of all
// policies without that fact. Throws core::Error for an unknown action space.
skills::ActionSpace ActionSpaceOf(const rl::Policy& policy);

// Returns the path of a cell's shipped policy.
std::filesystem::path ShippedPolicy(const std::filesystem::path& models, const std::string& cell);

// Makes `count` instances of the cell's kind, with seeds from `seed` on, in folder/assets unless
// they exist, and folder/tasks.json with one task per way to perform the cell's subtask. Returns
// that file. `photo`: the photo to reconstruct for the kind "photo". Throws core::Error.
std::filesystem::path MakeCellTasks(const SuiteCell& cell, std::uint64_t seed, int count,
                                    const std::filesystem::path& photo,
                                    const std::filesystem::path& folder, core::Progress* progress);

}  // namespace simwright::workflows
