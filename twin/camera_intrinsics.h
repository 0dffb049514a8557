#pragma once

#include <filesystem>

#include <Eigen/Core>

#include "core/finding.h"

namespace simwright::twin {

// The lens of a photo as its calibration tells it.
struct CameraIntrinsics {
  double focal = 1.0;                   // over the photo's width
  Eigen::Vector2d principal{0.5, 0.5};  // point, in widths and heights of the photo
  core::Findings findings;              // of what a picture with square pixels cannot express
};

// Reads a calibration for photos of `width` x `height` pixels: JSON or YAML with `fx`, `fy`, `cx`
// and `cy`, or with a matrix of nine numbers as ROS writes it (`camera_matrix: data`, or `K`); with
// the size of its own pictures (`width` and `height`, or `image_width` and `image_height`), from
// which it is scaled. Distortion is not undone, and reported. Throws core::Error, naming the file,
// where a number is missing or implausible, the pictures have another aspect, the pixels are not
// square, or the principal point is farther than a quarter of a side from the centre.
CameraIntrinsics ReadCameraIntrinsics(const std::filesystem::path& file, int width, int height);

}  // namespace simwright::twin
