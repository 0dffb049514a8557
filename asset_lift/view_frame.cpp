#include "asset_lift/view_frame.h"

#include <algorithm>

namespace simwright::asset_lift {

Eigen::Vector3d ViewFrame::Direction() const {
  return camera.Ray({center_x, center_y}).normalized();
}

Eigen::Vector3d ViewFrame::PointAt(const Eigen::Vector3d& uvw) const {
  const Eigen::Vector3d ray = camera.Ray({center_x + half * uvw.x(), center_y + half * uvw.y()});
  return camera.position() + (depth + uvw.z() * Radius()) / ray.dot(Direction()) * ray;
}

Eigen::Vector3d ViewFrame::Locate(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d pixel = camera.Project(point);
  return {(pixel.x() - center_x) / half, (pixel.y() - center_y) / half,
          ((point - camera.position()).dot(Direction()) - depth) / Radius()};
}

ViewFrame FrameAround(const Matte& matte, const core::Camera& camera, double depth, double margin) {
  ViewFrame frame;
  frame.camera = camera;
  frame.center_x = 0.5 * (matte.left + matte.right);
  frame.center_y = 0.5 * (matte.top + matte.bottom);
  frame.half = 0.5 * margin * std::max({1, matte.right - matte.left, matte.bottom - matte.top});
  frame.depth = depth;
  return frame;
}

}  // namespace simwright::asset_lift
