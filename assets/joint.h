#pragma once

#include <optional>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace simwright::assets {

enum class JointType { kFixed, kRevolute, kContinuous, kPrismatic, kFloating, kPlanar };

// A mimic relation: position = multiplier * leader's + offset.
struct JointMimic {
  std::string joint;  // the leader
  double multiplier = 1.0;
  double offset = 0.0;  // rad or m
};

// A joint between two links. At position zero the child link's frame is the joint's.
struct Joint {
  std::string name, parent, child;  // `parent` and `child`: links
  JointType type = JointType::kFixed;
  Eigen::Isometry3d parent_from_joint = Eigen::Isometry3d::Identity();  // at position zero
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();                      // joint frame, unit
  double lower = 0.0, upper = 0.0;                                      // rad or m
  double damping = 0.0;                                                 // N m s/rad or N s/m
  double friction = 0.0;  // N m or N: a smaller load does not move the joint
  double effort = 0.0;    // limit, N m or N; 0 if the file gives none
  double velocity = 0.0;  // limit, rad/s or m/s; 0 if the file gives none
  std::optional<JointMimic> mimic = std::nullopt;

  bool Moves() const { return type != JointType::kFixed; }
};

// Two links, by name, whose contacts are disabled.
using ExcludedPair = std::pair<std::string, std::string>;

// Returns the motion of a joint: joint-at-zero from joint-at-`position`. It is the identity for
// fixed, floating and planar joints.
Eigen::Isometry3d JointMotion(const Joint& joint, double position);

}  // namespace simwright::assets
