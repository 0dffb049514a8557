#pragma once

#include "manipulation/interaction.h"

namespace simwright::manipulation {

// Returns the interaction's goal (m, world), adapted to `state`. The goal of an object to be
// lifted, if another object occupies it or the room that the gripper needs there, is moved above
// the object, at the described height. The goal of an object taken out of a side-opening receptacle
// moves with the receptacle. Any other goal is unchanged.
Eigen::Vector3d GoalIn(const Interaction& interaction, const tasks::WorldState& state);

}  // namespace simwright::manipulation
