#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "capture/capture.h"
#include "capture/structure_from_motion.h"

namespace simwright::capture {

// Reconstructed cameras against the true ones.
struct CameraAlignment {
  int registered = 0;
  Eigen::Affine3d truth_from_found = Eigen::Affine3d::Identity();  // a similarity
  // Distances of the cameras from the true ones, percent of the orbit's radius: the true cameras'
  // mean distance from the origin.
  double median_percent = 0.0, worst_percent = 0.0;
};

// Aligns the found cameras' positions with the true ones by the similarity of least squares
// (Umeyama 1991). `found`: per photo; none: not placed. `poses`: world_from_camera per photo, m.
CameraAlignment AlignCameras(const std::vector<std::optional<Eigen::Vector3d>>& found,
                             const std::vector<Eigen::Isometry3d>& poses);
CameraAlignment AlignCameras(const Structure& structure,
                             const std::vector<Eigen::Isometry3d>& poses);
CameraAlignment AlignCameras(const Capture& capture, const std::vector<Eigen::Isometry3d>& poses);

}  // namespace simwright::capture
