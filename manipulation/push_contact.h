#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "tasks/articulated_object.h"
#include "tasks/world_state.h"

namespace simwright::manipulation {

// Returns true if `joint` at the described `position` (rad) is to be swung back to its rest
// position: a door or a lid that is to be shut. False for a knob, which rotates in place.
bool IsClosedByPushing(const tasks::ArticulatedObject& object, const tasks::ObjectJoint& joint,
                       double position);

// Returns the candidate poses for pushing a part on `joint` shut, in the frame of the link that the
// joint moves, the most natural first: x along the part's direction of motion, the sides of the
// fingers on the face behind it, near the free edge and an edge over which the palm stays clear.
// From above if the axis is vertical and the edge is low, then past the free edge; last with the
// fingertips on the face. Pushing needs no handle; the handle of an open door points towards the
// robot's base. `base`: m, the height of the robot's base. `joint`: one of the object's own, that
// IsClosedByPushing.
std::vector<Eigen::Isometry3d> PushingPoses(const tasks::WorldModel& model,
                                            const tasks::WorldState& start, int object,
                                            const tasks::ObjectJoint& joint, double base);

}  // namespace simwright::manipulation
