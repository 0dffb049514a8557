#pragma once

#include <Eigen/Core>

#include "asset_lift/observed_view.h"
#include "asset_lift/segmentation.h"
#include "core/camera.h"
#include "core/random.h"

namespace simwright::asset_lift {

// The frustum-shaped block of space behind a square crop of a picture, which the learned priors see
// and fill: u to the right and v down over the crop, w away from the camera, 0 in the middle.
struct ViewFrame {
  core::Camera camera;                // of the whole picture
  double center_x = 0, center_y = 0;  // of the crop, pixels
  double half = 1;                    // half the crop's side, pixels
  double depth = 1;                   // of w = 0 along the crop's central ray, m

  // Half the crop's side at `depth`, m: the unit of w.
  double Radius() const { return depth * half / camera.fx; }
  // The world point at (u, v, w).
  Eigen::Vector3d PointAt(const Eigen::Vector3d& uvw) const;
  // (u, v, w) of a world point in front of the camera.
  Eigen::Vector3d Locate(const Eigen::Vector3d& point) const;
  // The camera whose picture of `side` pixels a side is just the crop.
  core::Camera CropCamera(int side) const;
  // Unit direction of the central ray, world.
  Eigen::Vector3d Direction() const;
};

// The frame of a matte's object: its box fills 1 / `margin` of the crop's side, and the volume's
// middle lies at `depth` (m).
ViewFrame FrameAround(const Matte& matte, const core::Camera& camera, double depth,
                      double margin = 1.15);

// A camera on a sphere about the world's origin, as far as the frame's, even over the band between
// the two elevations (rad), `side` pixels a side. It sees a quarter more than the crop, since other
// sides of the object may be longer.
core::Camera RandomCameraAround(const ViewFrame& frame, double elevation_min, double elevation_max,
                                int side, core::Rng* rng);

// The crop of `frame` out of a picture, averaged by area, as a view of `side` pixels a side with
// its own camera. Throws core::Error unless `photo` and `alpha` (1 channel) are of one size and
// `side` >= 1.
ObservedView CropView(const core::Image& photo, const core::Image& alpha, const ViewFrame& frame,
                      int side);

}  // namespace simwright::asset_lift
