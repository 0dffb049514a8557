#pragma once

#include <optional>

#include "rl/detour.h"
#include "rl/skill.h"

namespace simwright::rl {

// How an arm brings the thing that it holds to its destination.
struct CarryPlan {
  double turn = 0.0;       // rad about the upright that the hand turns by, and the thing with it
  robot::Posture arrival;  // (J) where the hand stays back before it puts the thing down
  Detour via;              // on the way there
};

// What is asked of a plan. Poses: world_from_tool.
struct CarryTask {
  Eigen::Isometry3d there;  // the hand when the thing has come to its destination
  Eigen::Vector3d back;     // m, world: from there to where it stays back before it
  bool may_turn = false;    // whether the hand may come there turned otherwise
};

// The least turn, and of some postures the one soonest reached from `from`, from which the tool
// goes to its destination and the arm, but for the thing `held`, is in nothing there nor on its way
// to the posture, straight from joint to joint, else by a detour, else by one that is searched for.
// Without such a one, of those that reach. None where none does. A tool that only ever goes
// straight at a far destination ends at a joint's limit, or in furniture.
std::optional<CarryPlan> PlanCarry(const Skill& skill, const SkillVariant& variant,
                                   const tasks::SceneState& state, const CarryTask& task,
                                   const robot::Posture& from);

}  // namespace simwright::rl
