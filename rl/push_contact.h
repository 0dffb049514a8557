#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "tasks/scene_state.h"
#include "tasks/thing.h"

namespace simwright::rl {

// Whether `joint`, described as standing at `position` (rad), is to be swung back to its rest: a
// door or a lid that is shut, not a knob, which turns in place.
bool IsSwungShut(const tasks::Thing& thing, const tasks::ThingJoint& joint, double position);

// Where a hand pushes what swings on `joint` shut, in the frame of the link that it moves, the most
// natural first: x along the part's way, the fingers' sides on the face that is behind it, near the
// free edge and an edge over which the palm stays out of the way. From above where the axis is
// upright and the edge low, then past the free edge; last with the fingertips on the face. A hand
// that pushes needs no handle, which an open door holds out to where the robot stands. `base`: m,
// the height of the robot's base. `joint`: one of the thing's own, that IsSwungShut.
std::vector<Eigen::Isometry3d> ToolsPushingShut(const tasks::SceneModel& model,
                                                const tasks::SceneState& start, int thing,
                                                const tasks::ThingJoint& joint, double base);

}  // namespace simwright::rl
