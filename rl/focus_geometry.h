#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rl/focus.h"

namespace simwright::rl {

// How what the hand works on looks and moves, seen from a frame at the hand.
struct FocusGeometry {
  // m, of the part's outline (of the whole thing's, where no joint moves it) along the frame's
  // axes.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // m, of that box, from the frame's origin
  // Which way the part at the frame's origin goes as its joint goes up: unit; zero without a joint,
  // or on its axis.
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  // m, from the frame's origin to the nearest point of the axis that the part turns about; zero for
  // one that slides, or has no joint.
  Eigen::Vector3d hinge = Eigen::Vector3d::Zero();
};

// `world_from_frame`: a pose, ToolAtFocus as a rule.
FocusGeometry GeometryOf(const tasks::SceneModel& model, const tasks::SceneState& state,
                         const Focus& focus, const Eigen::Isometry3d& world_from_frame);

}  // namespace simwright::rl
