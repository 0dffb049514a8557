#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/robot_model.h"
#include "sim/articulated_body.h"

namespace simwright::rl {

// Points on the surface of a robot's hand, fingers open, m, in the tool's frame, about
// `spacing` (m) apart: all links from the arm's last joint on. Empty where they have no shapes.
std::vector<Eigen::Vector3d> HandSurface(const robot::RobotModel& robot, double spacing);

// How deep (m) the deepest of `points` (tool's frame) lies in the floor (z < 0) or in a convex part
// of `body`, whose links stand at `world_from_links` (links); 0 where all are free. Parts of the
// link `gripped` do not count.
double DeepestPoint(const std::vector<Eigen::Vector3d>& points,
                    const Eigen::Isometry3d& world_from_tool, const sim::ArticulatedBody& body,
                    const std::vector<Eigen::Isometry3d>& world_from_links, int gripped);

}  // namespace simwright::rl
