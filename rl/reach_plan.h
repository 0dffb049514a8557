#pragma once

#include <optional>

#include "rl/skill.h"

namespace simwright::rl {

// world_from_tool at work: on the focus. `tool_yaw` (rad): the yaw of the tool's y axis now, to
// which the hand stays near where its sides are alike. `pitch` (rad): the hand leans by so much
// about its own y axis, the line from finger to finger, about which a bar may be taken anyhow.
Eigen::Isometry3d ToolAtFocus(const SkillVariant& variant, const tasks::SceneState& state,
                              double tool_yaw, double pitch);

// The yaw, about the world's z, of the tool's y axis.
double ToolYaw(const Eigen::Isometry3d& world_from_tool);

// How an arm does its work.
struct ReachPlan {
  double pitch = 0.0;      // rad, of the hand
  robot::Posture at_work;  // (J) with the tool at the focus
};

// The least pitch, and a posture, from which the tool goes along most of the joint's way, or with
// the thing to its destination, off by no more than a centimetre and 0.15 rad. None where no pitch
// does. Postures are sought from `from`, then at random: a tool that only ever goes straight at its
// target ends at some joint's limit every other time.
std::optional<ReachPlan> PlanReach(const Skill& skill, const SkillVariant& variant,
                                   const tasks::SceneState& state, const robot::Posture& from,
                                   core::Rng& rng);

}  // namespace simwright::rl
