#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rl/convex_solid.h"
#include "robot/robot_model.h"
#include "sim/articulated_body.h"
#include "tasks/thing.h"

namespace simwright::rl {

// Points on the surface of a robot's hand, fingers open, m, in the tool's frame, about
// `spacing` (m) apart: all links from the arm's last joint on. Empty where they have no shapes.
SurfacePoints HandSurface(const robot::RobotModel& robot, double spacing);

// How deep (m) the deepest point of `surface`, which stands at `world_from_surface`, lies in the
// floor (z < 0) or in a part of a body, whose links stand at `world_from_links` (links); 0 where
// all are free. Parts of the link `gripped` do not count.
double DeepestPoint(const SurfacePoints& surface, const Eigen::Isometry3d& world_from_surface,
                    const BodySolids& body, const std::vector<Eigen::Isometry3d>& world_from_links,
                    int gripped);

// The same without the floor.
double DeepestInBody(const SurfacePoints& surface, const Eigen::Isometry3d& world_from_surface,
                     const BodySolids& body, const std::vector<Eigen::Isometry3d>& world_from_links,
                     int gripped = -1);

// world_from_link of each of the links of `body`, which is `thing`'s, at `root`, its joints at
// `joints`. (links)
std::vector<Eigen::Isometry3d> BodyPoses(const sim::ArticulatedBody& body,
                                         const tasks::Thing& thing, const Eigen::Isometry3d& root,
                                         const std::vector<double>& joints);

// Points on the surface of each of a robot's links, m, in the link's frame. (urdf.links)
std::vector<SurfacePoints> RobotSurface(const robot::RobotModel& robot, double spacing);

}  // namespace simwright::rl
