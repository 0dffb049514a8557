#include "asset_lift/priors/view_prior.h"

#include <cmath>

namespace simwright::asset_lift {

RelativeCamera RelativeTo(const core::Camera& reference, const core::Camera& camera) {
  const Eigen::Vector3d from = reference.position(), to = camera.position();
  RelativeCamera relative;
  relative.elevation = std::asin(to.z() / to.norm()) - std::asin(from.z() / from.norm());
  const double turn = std::atan2(to.y(), to.x()) - std::atan2(from.y(), from.x());
  relative.azimuth = std::remainder(turn, 2.0 * M_PI);
  relative.distance = to.norm() / from.norm() - 1.0;
  return relative;
}

}  // namespace simwright::asset_lift
