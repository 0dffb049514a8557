#pragma once

#include <optional>
#include <string>

#include "tasks/rules/planner.h"
#include "tasks/verification/motion.h"
#include "tasks/world_state.h"

namespace simwright::tasks {

// A grounded operator: the description and the reward program of what a policy must learn.
struct Step {
  std::string name;         // "open_microwave_door"
  std::string description;  // "Open the door of the microwave."
  std::string program;
  std::string success;                  // "door_joint of microwave past 70 % of its way"
  std::optional<Eigen::Vector3d> goal;  // m, world
  Action action;                        // the action of an ideal gripper
};

// Returns the step for operator `one` in `state`; objects are put down and pushed sideways as the
// robot at `world_from_robot` sees it. The reward of every step is bounded, increases
// monotonically up to success, and requires contact where an object is held.
Step MakeStep(const WorldModel& model, const WorldState& state, const Operator& one,
              const Eigen::Isometry3d& world_from_robot = Eigen::Isometry3d::Identity());

// Returns the object's name as it appears in a sentence: its name with blanks ("red mug" for
// red_mug).
std::string SpokenName(const ArticulatedObject& object);

// Returns `text` as the name of a task or subtask: ASCII characters other than letters and digits
// become '_'.
std::string NameFrom(std::string text);

}  // namespace simwright::tasks
