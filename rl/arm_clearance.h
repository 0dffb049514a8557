#pragma once

#include "rl/skill.h"

namespace simwright::rl {

// Whether the robot at `arm` (J), fingers open, is in none of the things that the variant places,
// as far as its surface, looked at every few centimetres, can tell. The thing `held` (-1: none)
// does not count.
bool IsArmClear(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
                const robot::Posture& arm, int held = -1);

}  // namespace simwright::rl
