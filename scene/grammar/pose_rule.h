#pragma once

#include <string>

#include <Eigen/Geometry>

#include "core/random.h"

namespace simwright::scene {

// Where a symbol of a grammar stands, given its parent. The kinds are those of Pfaff et al.,
// Steerable Scene Generation, appendix (after Izatt and Tedrake's spatial scene grammars).

enum class PositionKind {
  kOffset,        // parent's pose times `mean`
  kGaussian,      // parent's pose times a draw of N(mean, diag(deviation^2))
  kBoxInWorld,    // uniform in [low, high], world coordinates
  kBoxOnSurface,  // uniform in [low, high], in the frame of the surface above, else the world's
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
  kFreeYaw,       // parent's rotation, turned about its z by a uniform angle
  kConcentrated,  // parent's rotation times `mean` times exp(v), v a draw of N(0,
                  // diag(deviation^2))
};

// The concentrated kind stands for the paper's Bingham rule of density ~ exp(-sum_i z_i q_i^2) over
// the vector part q of the unit quaternion of the turn off the mean. A turn by a small rotation
// vector v has q = v / 2, so that the density is exp(-sum_i z_i v_i^2 / 4), a Gaussian of
// deviation sqrt(2 / z_i): 0.14 rad for z = 100. The paper's z = 1e6 (0.0014 rad) is 0 here, and
// its z = 1 about the vertical is the free yaw.
struct RotationRule {
  RotationKind kind = RotationKind::kOffset;
  Eigen::Quaterniond mean = Eigen::Quaterniond::Identity();
  Eigen::Vector3d deviation = Eigen::Vector3d::Zero();  // rad
};

struct PoseRule {
  PositionRule position;
  RotationRule rotation;

  // The same position, with another rotation. Yaw: about z, counter-clockwise from above; rad.
  PoseRule FacingAnyWay() const;
  PoseRule Turned(double yaw) const;
  PoseRule Turned(double yaw, double yaw_deviation) const;
  PoseRule Rotated(const Eigen::Quaterniond& mean, const Eigen::Vector3d& deviation) const;

  // False for a rule that always gives the same pose.
  bool IsRandom() const;
  bool IsValid(std::string* error) const;
};

// How a specification writes its rules: `GaussianOffset(...).FacingAnyWay()`.
PoseRule SamePose();
PoseRule Offset(double x, double y, double z = 0.0);
PoseRule GaussianOffset(const Eigen::Vector3d& mean, const Eigen::Vector3d& deviation);
PoseRule UniformInWorld(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
PoseRule UniformOnSurface(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

// The deviation of a rotation vector, rad, that stands for a Bingham concentration z > 0 (above).
double DeviationOfConcentration(double z);

// A draw of world_from_child. `world_from_surface`: the nearest surface above the child.
Eigen::Isometry3d DrawPose(const PoseRule& rule, const Eigen::Isometry3d& world_from_parent,
                           const Eigen::Isometry3d& world_from_surface, core::Rng& rng);

}  // namespace simwright::scene
