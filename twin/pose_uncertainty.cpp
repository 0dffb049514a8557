#include "twin/pose_uncertainty.h"

#include <algorithm>
#include <cmath>

namespace simwright::twin {
namespace {

constexpr double kPictureShare = 0.004;  // of the picture's width
constexpr double kBoxShare = 0.15;       // of the box's diagonal, for an outline of IoU 0
constexpr double kHiddenFactor = 2.0;
constexpr double kLeastSine = 0.1;  // of the angle of the line of sight to the plane
constexpr double kMostYaw = M_PI / 2.0;

}  // namespace

PoseUncertainty UncertaintyOf(const TableFit& fit, const Eigen::AlignedBox2d& box,
                              const core::Camera& camera, bool hidden, double log_scale_error) {
  const double side = std::max(1.0, box.diagonal().norm());
  double pixels = kPictureShare * camera.width + kBoxShare * (1.0 - fit.agreement.iou) * side;
  if (hidden) pixels *= kHiddenFactor;
  const Eigen::Vector3d ray = Eigen::Vector3d(fit.pose.x, fit.pose.y, 0.0) - camera.position();
  const double distance = ray.norm();
  const double sine = std::max(kLeastSine, -ray.z() / distance);
  const double across = pixels * distance / camera.fx;
  PoseUncertainty uncertainty;
  uncertainty.position = across * std::sqrt(0.5 * (1.0 + 1.0 / (sine * sine)));
  const double longer = fit.instance.size.head<2>().maxCoeff();
  uncertainty.yaw = std::min(kMostYaw, across / std::max(1e-3, 0.5 * longer));
  uncertainty.size = std::hypot(pixels / side, log_scale_error);
  return uncertainty;
}

}  // namespace simwright::twin
