#include "importers/joint_friction.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "assets/joint_gravity_load.h"
#include "assets/kinematic_model.h"
#include "library/articulated/assembly.h"

namespace simwright::importers {
namespace {

using assets::ArticulatedAsset;
using assets::Joint;
using assets::JointType;

constexpr double kGravity = 9.81;     // m/s^2
constexpr double kWeightShare = 0.1;  // of the asset's weight: the largest required force
constexpr int kLoadSamples = 32;      // positions over a joint's range

double LowerOf(const Joint& joint) {
  return joint.type == JointType::kContinuous ? -std::numbers::pi : joint.lower;
}
double RangeOf(const Joint& joint) {
  return joint.type == JointType::kContinuous ? 2.0 * std::numbers::pi : joint.upper - joint.lower;
}

// Returns the distance from the axis of hinge `joint` to the farthest point it moves, m; 1 for a
// slide.
double LeverOf(const ArticulatedAsset& asset, const std::vector<Eigen::Isometry3d>& poses,
               const std::vector<int>& parents, size_t joint) {
  if (asset.joints[joint].type == JointType::kPrismatic) return 1.0;
  const Eigen::Isometry3d& pose = poses[joint + 1];
  const Eigen::Vector3d axis = pose.linear() * asset.joints[joint].axis;
  std::vector<bool> carried(asset.links.size(), false);
  double lever = 0.0;
  for (size_t i = joint; i < asset.joints.size(); ++i) {
    carried[i + 1] = i == joint || carried[static_cast<size_t>(parents[i])];
    if (!carried[i + 1]) continue;
    for (const core::TriangleMesh& part : asset.links[i + 1].parts) {
      for (const Eigen::Vector3d& v : part.vertices) {
        lever = std::max(lever, (poses[i + 1] * v - pose.translation()).cross(axis).norm());
      }
    }
  }
  return lever;
}

}  // namespace

double GreatestLoad(const ArticulatedAsset& asset, size_t joint) {
  const auto model = assets::MakeKinematicModel(asset);
  const Joint& j = asset.joints[joint];
  double load = 0.0;
  for (int k = 0; k <= kLoadSamples; ++k) {
    const double position = LowerOf(j) + RangeOf(j) * k / kLoadSamples;
    load =
        std::max(load, std::abs(assets::LoadOn(*model, static_cast<int>(joint), position).gravity));
  }
  return load;
}

void AssignJointFriction(core::Rng& rng, ArticulatedAsset* asset) {
  const auto model = assets::MakeKinematicModel(*asset);
  const std::vector<Eigen::Isometry3d> poses =
      model->LinkPoses(std::vector<double>(asset->joints.size(), 0.0));
  double mass = 0.0;
  for (const assets::ArticulatedLink& link : asset->links) mass += link.inertial.mass;
  for (size_t i = 0; i < asset->joints.size(); ++i) {
    Joint& joint = asset->joints[i];
    if (!joint.Moves()) continue;
    const double lever = LeverOf(*asset, poses, model->parents(), i);
    library::JointResistance feel = library::SampleJointResistance(rng, lever);
    const double most = kWeightShare * mass * kGravity * lever;
    if (!asset->fixed && feel.friction > most) {
      feel.damping *= most / feel.friction;
      feel.friction = most;
    }
    const double load = GreatestLoad(*asset, i);
    if (!(joint.damping > 0.0)) joint.damping = feel.damping;
    if (!(joint.friction > 0.0)) joint.friction = feel.friction;
    joint.friction = std::max(joint.friction, kHoldFactor * load);
    if (!(joint.effort > 0.0)) joint.effort = 4.0 * (joint.friction + load);
    if (!(joint.velocity > 0.0)) joint.velocity = 5.0 * RangeOf(joint);
  }
}

}  // namespace simwright::importers
