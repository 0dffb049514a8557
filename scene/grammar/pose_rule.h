#pragma once

#include <string>

#include <Eigen/Geometry>

#include "core/random.h"

namespace simwright::scene {

// The pose of a symbol of a grammar relative to its parent. The kinds are those of Pfaff et al.,
// Steerable Scene Generation, appendix (after Izatt and Tedrake's spatial scene grammars).

enum class PositionKind {
  kOffset,        // parent's pose times `mean`
  kGaussian,      // parent's pose times a sample of N(mean, diag(deviation^2))
  kBoxInWorld,    // uniform in [low, high], world coordinates
  kBoxOnSurface,  // uniform in [low, high], in the frame of the nearest surface, else the world's
};

// `mean` and `deviation` serve the first two kinds, `low` and `high` the boxes. Metres.
struct PositionRule {
  PositionKind kind = PositionKind::kOffset;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d deviation = Eigen::Vector3d::Zero();
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
};

enum class RotationKind {
  kOffset,        // parent's rotation times `mean`
  kFreeYaw,       // parent's rotation times a uniform rotation about its z
  kConcentrated,  // parent's rotation times `mean` times exp(v), v sampled from N(0,
                  // diag(deviation^2))
};

// The concentrated kind approximates the paper's Bingham rule of density ~ exp(-sum_i z_i q_i^2)
// over the vector part q of the unit quaternion of the rotation from the mean. A rotation by a
// small rotation vector v has q = v / 2, so that the density is exp(-sum_i z_i v_i^2 / 4), a
// Gaussian of deviation sqrt(2 / z_i): 0.14 rad for z = 100. The paper's z = 1e6 (0.0014 rad) is 0
// here, and its z = 1 about the vertical is the free yaw.
struct RotationRule {
  RotationKind kind = RotationKind::kOffset;
  Eigen::Quaterniond mean = Eigen::Quaterniond::Identity();
  Eigen::Vector3d deviation = Eigen::Vector3d::Zero();  // rad
};

struct PoseRule {
  PositionRule position;
  RotationRule rotation;

  // Returns a rule with the same position and another rotation. Yaw: about z, counter-clockwise
  // from above; rad.
  PoseRule WithFreeYaw() const;
  PoseRule WithYaw(double yaw) const;
  PoseRule WithYaw(double yaw, double yaw_deviation) const;
  PoseRule WithRotation(const Eigen::Quaterniond& mean, const Eigen::Vector3d& deviation) const;

  // Returns false for a rule that always gives the same pose.
  bool IsRandom() const;
  bool IsValid(std::string* error) const;
};

// Builders of rules, as in `GaussianOffset(...).WithFreeYaw()`.
PoseRule SamePose();
PoseRule Offset(double x, double y, double z = 0.0);
PoseRule GaussianOffset(const Eigen::Vector3d& mean, const Eigen::Vector3d& deviation);
PoseRule UniformInWorld(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
PoseRule UniformOnSurface(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

// Returns the deviation of the rotation vector, rad, that corresponds to a Bingham concentration z
// > 0 (see RotationRule).
double DeviationOfConcentration(double z);

// Samples world_from_child. `world_from_surface`: the nearest surface above the child.
Eigen::Isometry3d SamplePose(const PoseRule& rule, const Eigen::Isometry3d& world_from_parent,
                             const Eigen::Isometry3d& world_from_surface, core::Rng& rng);

}  // namespace simwright::scene
