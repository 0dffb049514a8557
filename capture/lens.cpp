#include "capture/lens.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace simwright::capture {

Eigen::Vector2d Lens::Project(const Eigen::Vector3d& point) const {
  const double x = point.x() / point.z(), y = point.y() / point.z();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {fx * (x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)) + cx,
          fy * (y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y) + cy};
}

core::Camera CropAround(const Eigen::AlignedBox3d& region, const Lens& lens,
                        const Eigen::Isometry3d& world_from_camera, int max_side) {
  const Eigen::Isometry3d camera_from_world = world_from_camera.inverse();
  Eigen::AlignedBox2d shown;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner =
        camera_from_world * region.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    if (!(corner.z() > 0.0)) continue;
    shown.extend(Eigen::Vector2d(lens.fx * corner.x() / corner.z() + lens.cx,
                                 lens.fy * corner.y() / corner.z() + lens.cy));
  }
  shown = shown.intersection(
      Eigen::AlignedBox2d(Eigen::Vector2d::Zero(), Eigen::Vector2d(lens.width, lens.height)));
  if (shown.isEmpty() || shown.sizes().minCoeff() < 2.0) {
    throw core::Error("the photo does not show the object's place", "capture");
  }
  const double scale = std::min(1.0, max_side / shown.sizes().maxCoeff());
  core::Camera crop;
  crop.width = std::max(2, static_cast<int>(std::lround(scale * shown.sizes().x())));
  crop.height = std::max(2, static_cast<int>(std::lround(scale * shown.sizes().y())));
  crop.fx = scale * lens.fx;
  crop.fy = scale * lens.fy;
  crop.cx = scale * (lens.cx - shown.min().x());
  crop.cy = scale * (lens.cy - shown.min().y());
  crop.world_from_camera = world_from_camera;
  return crop;
}

core::Image RemoveDistortion(const core::Image& photo, const Lens& lens, const core::Camera& crop) {
  if (photo.width != lens.width || photo.height != lens.height) {
    throw core::Error("the photo does not have the size of its lens", "lens distortion");
  }
  if (crop.width < 1 || crop.height < 1) throw core::Error("the crop is empty", "lens distortion");
  // Scaled down first: an average over areas instead of single pixels.
  const double scale = std::min(1.0, crop.fx / lens.fx);
  core::Image small;
  if (scale < 0.9) {
    small = core::Resize(photo, std::max(1, static_cast<int>(std::lround(scale * photo.width))),
                         std::max(1, static_cast<int>(std::lround(scale * photo.height))));
  }
  const core::Image& from = small.empty() ? photo : small;
  const double sx = static_cast<double>(from.width) / photo.width;
  const double sy = static_cast<double>(from.height) / photo.height;
  cv::Mat map_x(crop.height, crop.width, CV_32F), map_y(crop.height, crop.width, CV_32F);
  for (int y = 0; y < crop.height; ++y) {
    for (int x = 0; x < crop.width; ++x) {
      const Eigen::Vector2d at =
          lens.Project({(x + 0.5 - crop.cx) / crop.fx, (y + 0.5 - crop.cy) / crop.fy, 1.0});
      map_x.at<float>(y, x) = static_cast<float>(sx * at.x() - 0.5);
      map_y.at<float>(y, x) = static_cast<float>(sy * at.y() - 0.5);
    }
  }
  core::Image straight(crop.width, crop.height, photo.channels);
  const cv::Mat source(from.height, from.width, CV_8UC(from.channels),
                       const_cast<std::uint8_t*>(from.pixels.data()));
  cv::Mat target(crop.height, crop.width, CV_8UC(photo.channels), straight.pixels.data());
  cv::remap(source, target, map_x, map_y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return straight;
}

}  // namespace simwright::capture
