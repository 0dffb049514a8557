#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/mesh.h"
#include "core/random.h"

namespace simwright::library_fit {

// The direction from which a photo shows an object. Where the object lies in the photo and how
// large it appears is not part of it: its bounding box in the photo determines that.
struct FitView {
  double azimuth = 0.0;    // rad, of the camera about the object's z axis; pi: in front (-x)
  double elevation = 0.0;  // rad, of the camera above the object's centre
  double roll = 0.0;       // rad, of the camera about its optical axis
  // Half the diagonal of the object's bounds over the camera's distance from their centre.
  double nearness = 0.2;
};

// The bounds of `nearness`: fields of view of 12 to 50 degrees that the object's sphere fills.
inline constexpr double kLeastNearness = 0.09, kMostNearness = 0.42;

// Returns the camera of a square picture of `side` pixels in which the mesh has the bounding box
// `box` (pixels): exactly its centre, and the sum of its sides. The camera's principal point is
// displaced accordingly.
core::Camera CameraOf(const FitView& view, const core::TriangleMesh& mesh,
                      const Eigen::AlignedBox2d& box, int side);

// Returns the camera of a square crop of `side` pixels in which the longer side of the mesh's
// bounding box spans `middle` +- `half` (pixels).
core::Camera CropCameraOf(const FitView& view, const core::TriangleMesh& mesh,
                          const Eigen::Vector2d& middle, double half, int side);

// Samples a view as people take photos: from -5 to 72 degrees above, mostly 5 to 40; within 80
// degrees of the front, mostly 40, if `frontal`, else from all around; upright within 2 degrees.
FitView RandomView(bool frontal, core::Rng* rng);

}  // namespace simwright::library_fit
