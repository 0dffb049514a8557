#pragma once

#include <optional>
#include <string>

#include "tasks/rules/planner.h"
#include "tasks/scene_state.h"
#include "tasks/verification/motion.h"

namespace simwright::tasks {

// An operator on a scene as it stands: what a policy has to learn, in words and as a program.
struct Step {
  std::string name;         // "open_microwave_door"
  std::string description;  // "Open the door of the microwave."
  std::string program;
  std::string success;                  // "door_joint of microwave at least 70 % open"
  std::optional<Eigen::Vector3d> goal;  // m, world
  Action action;                        // how an ideal hand does it
};

// The reward of every step is bounded, rises all the way to success, and asks for contact where
// something is held.
Step StepOf(const SceneModel& model, const SceneState& state, const Operator& one);

// "the red_mug" -> how a sentence names the thing: its name with blanks.
std::string SpokenName(const Thing& thing);

// `text` as the name of a task or subtask: ASCII that is no letter or digit becomes '_'.
std::string NameFrom(std::string text);

}  // namespace simwright::tasks
