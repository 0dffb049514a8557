#pragma once

#include "core/random.h"
#include "skills/skill.h"

namespace simwright::skills {

// Returns true if the arm can do the manipulation of each of skill.later in the scene placed as in
// `state`: from home there is a joint path to the grasp, with each joint as that skill finds it,
// and the grasped object can be carried on to its next destination. `variant`: index into the
// skill's variants. Objects that earlier skills move are not checked.
bool IsDownstreamReachable(const Skill& skill, int variant, const tasks::WorldState& state,
                           core::Rng& rng);

}  // namespace simwright::skills
