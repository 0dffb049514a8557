#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "manipulation/convex_part.h"
#include "robot/robot_model.h"
#include "sim/articulated_body.h"
#include "tasks/articulated_object.h"

namespace simwright::manipulation {

// Samples points on the surface of the gripper, fingers open, m, tool frame, about `spacing` (m)
// apart: all links from the arm's last joint on. Empty if they have no collision shapes.
SurfacePoints GripperSurface(const robot::RobotModel& robot, double spacing);

// Returns the penetration depth (m) of `surface` at `world_from_surface` into the floor (z < 0) or
// the parts of a body with link poses `world_from_links` (links); 0 if collision-free. Parts of the
// link `gripped` are ignored.
double PenetrationDepth(const SurfacePoints& surface, const Eigen::Isometry3d& world_from_surface,
                        const BodyParts& body,
                        const std::vector<Eigen::Isometry3d>& world_from_links, int gripped);

// Returns the same without the floor.
double PenetrationIntoBody(const SurfacePoints& surface,
                           const Eigen::Isometry3d& world_from_surface, const BodyParts& body,
                           const std::vector<Eigen::Isometry3d>& world_from_links,
                           int gripped = -1);

// Returns world_from_link of each link of `object`, with the root at `root` and the joint positions
// `joints`. (links)
std::vector<Eigen::Isometry3d> WorldLinkPoses(const tasks::ArticulatedObject& object,
                                              const Eigen::Isometry3d& root,
                                              const std::vector<double>& joints);

// Samples points on the surfaces of a body's links, m, in the frame of `frame_from_links` (links),
// about `spacing` (m) apart.
SurfacePoints BodySurface(const sim::ArticulatedBody& body,
                          const std::vector<Eigen::Isometry3d>& frame_from_links, double spacing);

// Samples points on the surface of each of a robot's links, m, link frame. (urdf.links)
std::vector<SurfacePoints> RobotSurface(const robot::RobotModel& robot, double spacing);

}  // namespace simwright::manipulation
