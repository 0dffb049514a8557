#include "sim/max_displacement.h"

#include <cmath>

namespace simwright::sim {

double MaxDisplacement(const Eigen::Vector3d& center, double radius, const Eigen::Isometry3d& from,
                       const Eigen::Isometry3d& to) {
  const double turn = Eigen::AngleAxisd(from.linear().transpose() * to.linear()).angle();
  return (to * center - from * center).norm() + 2.0 * radius * std::sin(0.5 * turn);
}

}  // namespace simwright::sim
