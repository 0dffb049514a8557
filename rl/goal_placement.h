#pragma once

#include "rl/skill.h"

namespace simwright::rl {

// The variant's goal (m, world) as it is where the scene stands as in `state` and not as described:
// of what is to be lifted to a place that another thing or the hand's way to it is in the way of,
// above where it stands, as high as described; of what is to come out of a room, before the room
// wherever that is. Any other stays.
Eigen::Vector3d GoalIn(const SkillVariant& variant, const tasks::SceneState& state);

}  // namespace simwright::rl
