#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "rl/policy.h"
#include "rl/skill_options.h"
#include "tasks/task.h"

namespace simwright::pipeline {

// One skill of the suite that shows what training is worth: a subtask, on kinds of the library.
struct SuiteCell {
  std::string name;     // open_microwave_door
  std::string kind;     // of the library; "photo": the cup lifted from the example photo
  std::string pattern;  // of the tasks that it is taken from (ChooseTasks)
  int subtask = 0;      // which of their subtasks
  double minutes = 10;  // of training on two cores, at most
  // Cabinets are as high as the robot and their open doors stand beside it: that takes a base.
  std::string robot = "panda";
  int instances = 32;  // of the kind, to train on: with 8, those that it knew it did in 99 %,
                       // others in 89 % (opening microwaves)
};

// Training and evaluation see other instances of the kind: seeds from 1 on and from 301 on, of
// which there are so many.
constexpr std::uint64_t kSeenSeed = 1, kUnseenSeed = 301;
constexpr int kUnseenInstances = 8;

const std::vector<SuiteCell>& SkillSuite();

// Throws core::Error, listing those that are there.
const SuiteCell& CellOf(const std::string& name);

// What the policy's actions say: its fact `action`, else "focus", as of all from before there was
// that fact. Throws core::Error for an action space that there is not.
rl::ActionSpace ActionSpaceOf(const rl::Policy& policy);

// Where a cell's policy is shipped.
std::filesystem::path ShippedPolicy(const std::filesystem::path& models, const std::string& cell);

// Makes `count` instances of the cell's kind from `seed` on into folder/assets, unless they are
// there, and folder/tasks.json with a task of the cell's one subtask for each way to do it. Returns
// that file. `photo`: for the kind "photo", what is lifted. Throws core::Error.
std::filesystem::path MakeCellTasks(const SuiteCell& cell, std::uint64_t seed, int count,
                                    const std::filesystem::path& photo,
                                    const std::filesystem::path& folder, core::Progress* progress);

}  // namespace simwright::pipeline
