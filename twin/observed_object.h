#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/image.h"
#include "library_fit/fit_loss.h"
#include "twin/object_detector.h"

namespace simwright::twin {

// A detection, prepared for comparison with renders.
struct ObservedObject {
  Eigen::AlignedBox2d box;        // pixels of the photo, of the visible part
  Eigen::Vector2d centre;         // of the crop, pixels of the photo
  double half = 1.0;              // half the crop's side, pixels of the photo
  library_fit::FitTarget target;  // the crop; covered where a nearer object may hide it
  core::Image prior_crop;         // RGBA, the input of the library prior
  bool hidden = false;            // a nearer object touches it, or it reaches the border

  // Returns the camera of the crop for the photo's `camera`, in the same frame.
  core::Camera CropCamera(const core::Camera& camera) const;
};

// Prepares the detections of a photo (RGB). `side`: pixels per side of the compared crops. Leaves
// out none: result k belongs to detection k. Throws core::Error for an alpha without a pixel.
std::vector<ObservedObject> ObserveObjects(const core::Image& photo,
                                           const std::vector<Detection>& detections, int side);

}  // namespace simwright::twin
