#include "asset_lift/camera/view_frame.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

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

core::Camera ViewFrame::CropCamera(int side) const {
  core::Camera crop = camera;
  const double scale = side / (2.0 * half);
  crop.width = crop.height = side;
  crop.fx *= scale;
  crop.fy *= scale;
  crop.cx = (crop.cx - center_x + half) * scale;
  crop.cy = (crop.cy - center_y + half) * scale;
  return crop;
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

core::Camera RandomCameraAround(const ViewFrame& frame, double elevation_min, double elevation_max,
                                int side, core::Rng* rng) {
  const double elevation =
      std::asin(core::Uniform(*rng, std::sin(elevation_min), std::sin(elevation_max)));
  const double azimuth = core::Uniform(*rng, 0.0, 2.0 * M_PI);
  const double fov = 2.0 * std::atan(1.25 * frame.half / frame.camera.fx);
  return core::OrbitCamera(Eigen::Vector3d::Zero(), frame.camera.position().norm(), elevation,
                           azimuth, fov, side, side);
}

ObservedView CropView(const core::Image& photo, const core::Image& alpha, const ViewFrame& frame,
                      int side) {
  if (photo.width != alpha.width || photo.height != alpha.height || alpha.channels != 1 ||
      side < 1) {
    throw core::Error("a crop needs a photo and a matte of the same size");
  }
  ObservedView view;
  view.camera = frame.CropCamera(side);
  const double scale = side / (2.0 * frame.half);
  view.color = core::FloatImage(side, side, 3);
  view.opacity = core::FloatImage(side, side, 1);
  const int samples = std::clamp(static_cast<int>(std::ceil(1.0 / scale)), 2, 16);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      double sum[4] = {0, 0, 0, 0};
      for (int s = 0; s < samples * samples; ++s) {
        const int px = static_cast<int>(
            std::floor(frame.center_x - frame.half + (x + (s % samples + 0.5) / samples) / scale));
        const int py = static_cast<int>(
            std::floor(frame.center_y - frame.half + (y + (s / samples + 0.5) / samples) / scale));
        if (px < 0 || py < 0 || px >= photo.width || py >= photo.height) continue;
        const double share = alpha.At(px, py)[0] / 255.0;
        sum[3] += share;
        for (int c = 0; c < 3; ++c) {
          sum[c] += share * photo.At(px, py)[photo.channels < 3 ? 0 : c] / 255.0;
        }
      }
      view.opacity.At(x, y)[0] = static_cast<float>(sum[3] / (samples * samples));
      if (sum[3] <= 0.0) continue;
      for (int c = 0; c < 3; ++c) view.color.At(x, y)[c] = static_cast<float>(sum[c] / sum[3]);
    }
  }
  return view;
}

}  // namespace simwright::asset_lift
