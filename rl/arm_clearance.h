#pragma once

#include "rl/skill.h"

namespace simwright::rl {

// Whether the robot at `arm` (J), fingers open, is in none of the things that the variant places,
// as far as its surface, looked at every few centimetres, can tell.
bool IsArmClear(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
                const robot::Posture& arm);

}  // namespace simwright::rl
