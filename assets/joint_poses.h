#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "assets/urdf_reader.h"

namespace simwright::assets {

// Positions of joints by name, rad or m. A joint that is not named stands at zero.
using JointPositions = std::map<std::string, double>;

// The motion of a joint: joint-at-zero from joint-at-`position`. Fixed, floating and planar joints
// stay where they are.
Eigen::Isometry3d JointMotion(const UrdfJoint& joint, double position);

// Pose of each link in the frame of the root. (links)
// Joints that mimic another follow it, whatever `positions` says of them.
std::vector<Eigen::Isometry3d> LinkPoses(const UrdfModel& model, const JointPositions& positions);

// The same with all joints at zero, also those that mimic.
std::vector<Eigen::Isometry3d> LinkPosesAtZero(const UrdfModel& model);

// Index of each joint's parent link. (joints)
std::vector<int> ParentLinks(const UrdfModel& model);

}  // namespace simwright::assets
