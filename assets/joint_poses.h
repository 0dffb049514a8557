#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "assets/joint.h"
#include "assets/urdf_reader.h"

namespace simwright::assets {

// Joint positions by name, rad or m. A joint that is not named is at zero.
using JointPositions = std::map<std::string, double>;

// Returns the pose of each link in the root's frame. (links) Mimic joints follow their leader,
// regardless of their entry in `positions`.
std::vector<Eigen::Isometry3d> LinkPoses(const UrdfModel& model, const JointPositions& positions);

// Returns the same with all joints at zero, including mimic joints.
std::vector<Eigen::Isometry3d> LinkPosesAtZero(const UrdfModel& model);

// Returns the index of each joint's parent link. (joints)
std::vector<int> ParentLinks(const UrdfModel& model);

}  // namespace simwright::assets
