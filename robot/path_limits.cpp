#include "robot/path_limits.h"

#include <algorithm>
#include <cmath>

namespace simwright::robot {

PathLimits::PathLimits(const PathDerivatives& path, const std::vector<JointLimits>& limits)
    : path_(path),
      per_acceleration_(static_cast<Eigen::Index>(limits.size())),
      per_jerk_(per_acceleration_.size()),
      largest_(6, path.first.cols()) {
  Eigen::ArrayXd per_velocity(per_acceleration_.size());
  for (Eigen::Index j = 0; j < per_velocity.size(); ++j) {
    const JointLimits& limit = limits[static_cast<std::size_t>(j)];
    per_velocity[j] = 1.0 / limit.velocity;
    per_acceleration_[j] = 1.0 / limit.acceleration;
    per_jerk_[j] = 1.0 / limit.jerk;
  }
  for (Eigen::Index i = 0; i < points(); ++i) {
    const auto d1 = path.first.col(i).array().abs(), d2 = path.second.col(i).array().abs(),
               d3 = path.third.col(i).array().abs();
    largest_.col(i) << (d1 * per_velocity).maxCoeff(), (d1 * per_acceleration_).maxCoeff(),
        (d2 * per_acceleration_).maxCoeff(), (d1 * per_jerk_).maxCoeff(),
        (d2 * per_jerk_).maxCoeff(), (d3 * per_jerk_).maxCoeff();
  }
}

double PathLimits::Excess(Eigen::Index point, const TimeLaw::Slowness& slowness, double share,
                          bool exact) const {
  const double s = slowness.value, p = slowness.first / s;
  const double z = 3.0 * p * p - slowness.second / s;
  const double squared = share * s * s, cubed = squared * s;
  const auto largest = largest_.col(point);
  const auto d1 = path_.first.col(point).array(), d2 = path_.second.col(point).array(),
             d3 = path_.third.col(point).array();
  const double velocity = largest[0] / (share * s);
  if (!exact && velocity > 1.0) return velocity;
  double acceleration = 0.0, jerk = 0.0;
  // The sum of the largest terms bounds the largest sum.
  if (largest[2] + std::abs(p) * largest[1] > squared) {
    acceleration = ((d2 - p * d1).abs() * per_acceleration_).maxCoeff() / squared;
    if (!exact && acceleration > 1.0) return acceleration;
  }
  if (largest[5] + 3.0 * std::abs(p) * largest[4] + std::abs(z) * largest[3] > cubed) {
    jerk = ((d3 - 3.0 * p * d2 + z * d1).abs() * per_jerk_).maxCoeff() / cubed;
  }
  // Roots only where they matter: below 1 the largest ratio suffices.
  const double excess = std::max({velocity, acceleration, jerk});
  if (excess <= 1.0 || !exact) return excess;
  return std::max({velocity, std::sqrt(acceleration), std::cbrt(jerk)});
}

}  // namespace simwright::robot
