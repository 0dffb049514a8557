#pragma once

#include "core/random.h"
#include "rl/skill.h"

namespace simwright::rl {

// Whether the arm can do the work of each of skill.later in a scene placed as `state` is, as far as
// can be told beforehand: from home there is a way to it, with each joint as that skill finds it,
// and what it takes can go on to where the one after brings it. `variant`: of the skill, an index.
// What stands elsewhere by then is not looked at.
bool IsLaterWorkInReach(const Skill& skill, int variant, const tasks::SceneState& state,
                        core::Rng& rng);

}  // namespace simwright::rl
