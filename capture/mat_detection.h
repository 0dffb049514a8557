#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "capture/capture_mat.h"
#include "core/image.h"

namespace simwright::capture {

// The chessboard corners of a mat that a photo shows, occluded ones left out.
struct MatObservation {
  PaperSize paper = PaperSize::kA4;
  int width = 0, height = 0;            // of the photo, pixels
  std::vector<int> corners;             // (N) CaptureMat::Corner
  std::vector<Eigen::Vector2d> pixels;  // (N x 2) image points (core::Camera's convention)
};

// Finds the mat in a photo: the one with most markers, at least `kMinMatCorners` corners that do
// not lie on a line. Corners
// are located at the photo's full resolution. Returns nothing if the photo shows no mat. Throws
// core::Error for an empty photo.
constexpr int kMinMatCorners = 8;
std::optional<MatObservation> DetectMat(const core::Image& photo);

}  // namespace simwright::capture
