#pragma once

#include "core/camera.h"
#include "core/float_image.h"
#include "core/random.h"

namespace simwright::asset_lift {

// A rendering of the fitted object, or the gradient of a loss with respect to it.
struct ObjectImage {
  core::FloatImage color;    // (H x W x 3), sRGB, premultiplied by opacity: the object over black
  core::FloatImage opacity;  // (H x W x 1)
};

// A loss on images of the object from cameras that the loss itself chooses. Score distillation is
// one. A fit (of a radiance field or of a mesh) renders the requested image and descends.
class ImageObjective {
 public:
  virtual ~ImageObjective() = default;

  // Returns the camera of the next image; `progress` in [0, 1) is that of the fit.
  virtual core::Camera NextCamera(double progress, core::Rng* rng) = 0;

  // Returns the loss of `picture`, rendered from `camera`; sets `gradient` to dL/d(picture), of the
  // same size.
  virtual double Evaluate(const core::Camera& camera, const ObjectImage& picture, double progress,
                          core::Rng* rng, ObjectImage* gradient) = 0;
};

}  // namespace simwright::asset_lift
