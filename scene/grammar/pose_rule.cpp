#include "scene/grammar/pose_rule.h"

#include <cmath>
#include <numbers>

namespace simwright::scene {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

bool PoseRule::IsRandom() const {
  if (position.kind == PositionKind::kGaussian && !position.deviation.isZero(0.0)) return true;
  const bool box =
      position.kind == PositionKind::kBoxInWorld || position.kind == PositionKind::kBoxOnSurface;
  if (box && position.low != position.high) return true;
  if (rotation.kind == RotationKind::kFreeYaw) return true;
  return rotation.kind == RotationKind::kConcentrated && !rotation.deviation.isZero(0.0);
}

bool PoseRule::IsValid(std::string* error) const {
  for (const Vector3d& values : {position.mean, position.deviation, position.low, position.high,
                                 rotation.deviation, Vector3d(rotation.mean.vec())}) {
    if (!values.allFinite()) {
      *error = "a pose rule has a value that is not finite";
      return false;
    }
  }
  if (position.deviation.minCoeff() < 0.0 || rotation.deviation.minCoeff() < 0.0) {
    *error = "a deviation is negative";
    return false;
  }
  if ((position.high - position.low).minCoeff() < 0.0) {
    *error =
        "a box has its upper bound below its lower bound (an object too large for its surface?)";
    return false;
  }
  if (std::abs(rotation.mean.norm() - 1.0) > 1e-9) {
    *error = "a rotation's quaternion is not normalized";
    return false;
  }
  return true;
}

PoseRule PoseRule::WithFreeYaw() const {
  PoseRule rule = *this;
  rule.rotation.kind = RotationKind::kFreeYaw;
  return rule;
}

PoseRule PoseRule::WithYaw(double yaw) const {
  PoseRule rule = *this;
  rule.rotation.mean = Quaterniond(AngleAxisd(yaw, Vector3d::UnitZ()));
  return rule;
}

PoseRule PoseRule::WithYaw(double yaw, double yaw_deviation) const {
  return WithRotation(Quaterniond(AngleAxisd(yaw, Vector3d::UnitZ())), {0.0, 0.0, yaw_deviation});
}

PoseRule PoseRule::WithRotation(const Quaterniond& mean, const Vector3d& deviation) const {
  PoseRule rule = *this;
  rule.rotation = {RotationKind::kConcentrated, mean, deviation};
  return rule;
}

PoseRule SamePose() {
  return {};
}

PoseRule Offset(double x, double y, double z) {
  PoseRule rule;
  rule.position.mean = {x, y, z};
  return rule;
}

PoseRule GaussianOffset(const Vector3d& mean, const Vector3d& deviation) {
  PoseRule rule;
  rule.position.kind = PositionKind::kGaussian;
  rule.position.mean = mean;
  rule.position.deviation = deviation;
  return rule;
}

PoseRule UniformInWorld(const Vector3d& low, const Vector3d& high) {
  PoseRule rule;
  rule.position.kind = PositionKind::kBoxInWorld;
  rule.position.low = low;
  rule.position.high = high;
  return rule;
}

PoseRule UniformOnSurface(const Vector3d& low, const Vector3d& high) {
  PoseRule rule = UniformInWorld(low, high);
  rule.position.kind = PositionKind::kBoxOnSurface;
  return rule;
}

double DeviationOfConcentration(double z) {
  return std::sqrt(2.0 / z);
}

namespace {

// Samples each coordinate; fixed coordinates consume no random numbers.
Vector3d SampleGaussian(const Vector3d& mean, const Vector3d& deviation, core::Rng& rng) {
  Vector3d value = mean;
  for (int i = 0; i < 3; ++i) {
    if (deviation[i] > 0.0) value[i] += deviation[i] * core::Normal(rng);
  }
  return value;
}

Vector3d SampleInBox(const Vector3d& low, const Vector3d& high, core::Rng& rng) {
  Vector3d value = low;
  for (int i = 0; i < 3; ++i) {
    if (high[i] > low[i]) value[i] = core::Uniform(rng, low[i], high[i]);
  }
  return value;
}

Quaterniond SampleRotation(const RotationRule& rule, core::Rng& rng) {
  switch (rule.kind) {
    case RotationKind::kOffset:
      return rule.mean;
    case RotationKind::kFreeYaw:
      return Quaterniond(
          AngleAxisd(core::Uniform(rng, 0.0, 2.0 * std::numbers::pi), Vector3d::UnitZ()));
    case RotationKind::kConcentrated:
      break;
  }
  const Vector3d vector = SampleGaussian(Vector3d::Zero(), rule.deviation, rng);
  const double angle = vector.norm();
  if (angle == 0.0) return rule.mean;
  return rule.mean * Quaterniond(AngleAxisd(angle, vector / angle));
}

}  // namespace

Eigen::Isometry3d SamplePose(const PoseRule& rule, const Eigen::Isometry3d& world_from_parent,
                             const Eigen::Isometry3d& world_from_surface, core::Rng& rng) {
  Eigen::Isometry3d world_from_child = world_from_parent;
  const PositionRule& position = rule.position;
  switch (position.kind) {
    case PositionKind::kOffset:
      world_from_child.translation() = world_from_parent * position.mean;
      break;
    case PositionKind::kGaussian:
      world_from_child.translation() =
          world_from_parent * SampleGaussian(position.mean, position.deviation, rng);
      break;
    case PositionKind::kBoxInWorld:
      world_from_child.translation() = SampleInBox(position.low, position.high, rng);
      break;
    case PositionKind::kBoxOnSurface:
      world_from_child.translation() =
          world_from_surface * SampleInBox(position.low, position.high, rng);
      break;
  }
  world_from_child.linear() =
      world_from_parent.linear() * SampleRotation(rule.rotation, rng).toRotationMatrix();
  return world_from_child;
}

}  // namespace simwright::scene
