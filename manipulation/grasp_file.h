#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/json.h"
#include "manipulation/grasp.h"
#include "manipulation/parallel_gripper.h"

namespace simwright::manipulation {

inline constexpr const char* kGraspFileName = "grasps.json";  // in an asset's folder

// The trials of one joint of an articulated asset.
struct JointProof {
  std::string joint, link;  // names; the fingers hold the link
  int grasps = 0;           // proved
  double friction = 0.0;    // of the pair of link and finger
  int tried = 0, held_in_bullet = 0, held_in_both = 0;
  double coverage = 0.0;
  std::string reason = {};  // why there are no grasps, if so
};

// The proved grasps of an object by a gripper: the content of grasps.json (docs/grasps.md).
struct GraspSet {
  std::string object;  // name of the asset
  // Its file, relative to the asset's folder, in the object's frame, m; of an articulated asset its
  // URDF.
  std::string mesh;
  std::string gripper, base_link;
  Eigen::Isometry3d tool_from_base = Eigen::Isometry3d::Identity();
  double max_opening = 0.0;  // m
  double force = 0.0;        // N of each finger
  double friction = 0.0;     // of the pair of object and finger, in the trials; the least of all
  std::vector<ParallelGripper::Joint> joints;
  std::vector<Grasp> grasps;  // best quality first
  // The trials: candidates in Bullet, those proved there, those that also hold in MuJoCo, and the
  // share of the candidates that a grasp represents (GraspCoverage).
  int tried = 0, held_in_bullet = 0, held_in_both = 0;
  double coverage = 0.0;
  std::vector<JointProof> joint_proofs;  // of an articulated asset, by joint
};

// Returns the grasps that move a joint, best quality first, each in the frame of its link; none for
// an unknown joint and for a rigid asset.
std::vector<Grasp> GraspsOfJoint(const GraspSet& set, const std::string& joint);
// Returns the names of the links that the grasps hold, in alphabetical order; none for a rigid
// asset.
std::vector<std::string> GraspedLinks(const GraspSet& set);

// Returns the pose of the base link in the frame of GraspGen and ACRONYM, object_from_base: z along
// the approach, x along the closing axis; the origin is where the base link's lies along the
// approach.
Eigen::Isometry3d GraspGenPose(const GraspSet& set, const Grasp& grasp);
// Returns the pose of the base link, object_from_base.
Eigen::Isometry3d BaseLinkPose(const GraspSet& set, const Grasp& grasp);

// Returns true if the grasps are for this gripper: the same base link in the same pose, and no
// smaller opening.
bool IsForGripper(const GraspSet& set, const ParallelGripper& gripper);

core::OrderedJson GraspSetJson(const GraspSet& set);
// Reads grasps.json. Throws core::Error, naming the field, for another format.
GraspSet ReadGraspSet(const std::filesystem::path& file);

}  // namespace simwright::manipulation
