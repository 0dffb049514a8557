#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/json.h"
#include "manipulation/grasp.h"
#include "manipulation/grasp_proof.h"
#include "manipulation/parallel_gripper.h"

namespace simwright::manipulation {

inline constexpr const char* kGraspFileName = "grasps.json";  // in an asset's folder

// The proved grasps of an object by a gripper: the content of grasps.json (docs/grasps.md).
struct GraspSet {
  std::string object;  // name of the asset
  std::string mesh;    // its file, relative to the asset's folder, in the object's frame, m
  std::string gripper, base_link;
  Eigen::Isometry3d tool_from_base = Eigen::Isometry3d::Identity();
  double max_opening = 0.0;  // m
  double force = 0.0;        // N of each finger
  double friction = 0.0;     // of the pair of object and finger, in the trials
  std::vector<ParallelGripper::Joint> joints;
  std::vector<Grasp> grasps;  // best quality first
  // The trials: candidates in Bullet, those proved there, those that also hold in MuJoCo, and the
  // share of the candidates that a grasp represents (GraspCoverage).
  int tried = 0, held_in_bullet = 0, held_in_both = 0;
  double coverage = 0.0;
};

GraspSet MakeGraspSet(const GraspObject& object, const std::string& mesh,
                      const ParallelGripper& gripper, const ProvedGrasps& proved);

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
