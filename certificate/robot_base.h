#pragma once

#include <Eigen/Geometry>

#include "certificate/placed_scene.h"

namespace simwright::certificate {

class Planner;

// A place of a robot's base, on a stand in front of furniture.
struct RobotBase {
  Eigen::Isometry3d world_from_robot = Eigen::Isometry3d::Identity();
  int reached = 0, asked = 0;  // tool poses that the robot reaches there, of those tried
};

// Returns the base for working at the furniture `support`, which the robot faces along +x: of a
// small grid of distances from its front and of heights, the one from which the arm reaches most
// tool poses over its surfaces, leaning between level and straight down, without touching fixed
// bodies. Does not depend on free bodies, so that all scenes with the same furniture have one base.
RobotBase ChooseRobotBase(const Planner& planner, const PlacedScene& scene, int support);

}  // namespace simwright::certificate
