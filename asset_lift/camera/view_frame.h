#pragma once

#include <Eigen/Core>

#include "asset_lift/camera/observed_view.h"
#include "asset_lift/segmentation/segmentation.h"
#include "core/camera.h"
#include "core/random.h"

namespace simwright::asset_lift {

// The frustum-shaped block of space behind a square crop of an image, the domain of the learned
// priors: u to the right and v down over the crop, w away from the camera, 0 in the middle.
struct ViewFrame {
  core::Camera camera;                // of the whole image
  double center_x = 0, center_y = 0;  // of the crop, pixels
  double half = 1;                    // half the crop's side, pixels
  double depth = 1;                   // of w = 0 along the crop's central ray, m

  // Returns half the crop's side at `depth`, m: the unit of w.
  double Radius() const { return depth * half / camera.fx; }
  // Returns the world point at (u, v, w).
  Eigen::Vector3d PointAt(const Eigen::Vector3d& uvw) const;
  // Returns (u, v, w) of a world point in front of the camera.
  Eigen::Vector3d Locate(const Eigen::Vector3d& point) const;
  // Returns the camera whose image of `side` pixels per side is exactly the crop.
  core::Camera CropCamera(int side) const;
  // Returns the unit direction of the central ray, world.
  Eigen::Vector3d Direction() const;
};

// Returns the frame of a matte's object: its bounding box fills 1 / `margin` of the crop's side,
// and the volume's centre lies at `depth` (m).
ViewFrame FrameAround(const Matte& matte, const core::Camera& camera, double depth,
                      double margin = 1.15);

// Samples a camera on a sphere about the world's origin with the frame's distance, uniformly over
// the band between the two elevations (rad), with `side` pixels per side. Its field of view is a
// quarter wider than the crop's, since other sides of the object may be longer.
core::Camera RandomCameraAround(const ViewFrame& frame, double elevation_min, double elevation_max,
                                int side, core::Rng* rng);

// Returns the crop of `frame` from an image, averaged by area, as a view of `side` pixels per side
// with its own camera. Throws core::Error unless `photo` and `alpha` (1 channel) have the same size
// and `side` >= 1.
ObservedView CropView(const core::Image& photo, const core::Image& alpha, const ViewFrame& frame,
                      int side);

}  // namespace simwright::asset_lift
