#include "tests/capture/camera_alignment.h"

#include <algorithm>

namespace simwright::capture {

CameraAlignment AlignCameras(const std::vector<std::optional<Eigen::Vector3d>>& found,
                             const std::vector<Eigen::Isometry3d>& poses) {
  CameraAlignment alignment;
  std::vector<Eigen::Vector3d> from, to;
  double radius = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!found[i]) continue;
    from.push_back(*found[i]);
    to.push_back(poses[i].translation());
    radius += to.back().norm();
  }
  alignment.registered = static_cast<int>(from.size());
  if (from.size() < 3) return alignment;
  radius /= static_cast<double>(from.size());
  Eigen::Matrix3Xd a(3, from.size()), b(3, from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    a.col(static_cast<Eigen::Index>(i)) = from[i];
    b.col(static_cast<Eigen::Index>(i)) = to[i];
  }
  alignment.truth_from_found.matrix() = Eigen::umeyama(a, b, true);
  std::vector<double> errors;
  for (std::size_t i = 0; i < from.size(); ++i) {
    errors.push_back(100.0 * (alignment.truth_from_found * from[i] - to[i]).norm() / radius);
  }
  std::sort(errors.begin(), errors.end());
  alignment.median_percent = errors[errors.size() / 2];
  alignment.worst_percent = errors.back();
  return alignment;
}

CameraAlignment AlignCameras(const Structure& structure,
                             const std::vector<Eigen::Isometry3d>& poses) {
  std::vector<std::optional<Eigen::Vector3d>> found;
  for (const Structure::View& view : structure.views) {
    found.emplace_back();
    if (view.registered) found.back() = view.world_from_camera.translation();
  }
  return AlignCameras(found, poses);
}

CameraAlignment AlignCameras(const Capture& capture, const std::vector<Eigen::Isometry3d>& poses) {
  std::vector<std::optional<Eigen::Vector3d>> found(poses.size());
  for (const CaptureView& view : capture.views) {
    found[static_cast<std::size_t>(view.index)] = view.camera.position();
  }
  return AlignCameras(found, poses);
}

}  // namespace simwright::capture
