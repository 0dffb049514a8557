#pragma once

#include <cstdint>
#include <string>

#include "core/float_image.h"
#include "twin/table_camera.h"

namespace simwright::twin {

// Returns a depth image (m along the optical axis; 0: not measured) in the size of a photo, each
// pixel the nearest one of `depth`: values are never mixed across outlines. Throws core::Error,
// naming `where`, if its aspect is another, or fewer than 2 % of its pixels are measured.
core::FloatImage DepthOfPhoto(const core::FloatImage& depth, int width, int height,
                              const std::string& where);

// The table's plane in a depth image, as the camera above it.
struct DepthPlane {
  TableCamera camera;  // elevation, roll and height are the plane's, the lens is as given
  double share = 0.0;  // of the measured pixels that lie on the plane
  double error = 0.0;  // m, standard deviation of their heights
};

// Fits the plane of a table to the depth of a photo: RANSAC (Fischler and Bolles 1981) among the
// planes that give a valid camera (TableCamera::IsValid), then least squares over the points within
// three standard deviations. `lens`: focal length and principal point. Throws
// core::Error, naming `where` and what the largest plane is like, if no such plane holds 12 % of
// the measured pixels.
DepthPlane FitTablePlane(const core::FloatImage& depth, const TableCamera& lens, std::uint64_t seed,
                         const std::string& where);

}  // namespace simwright::twin
