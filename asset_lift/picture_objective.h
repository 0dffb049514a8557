#pragma once

#include "core/camera.h"
#include "core/float_image.h"
#include "core/random.h"

namespace simwright::asset_lift {

// The object as a fit shows it, or the gradient of a loss with respect to that.
struct ObjectPicture {
  core::FloatImage color;    // (H x W x 3), sRGB, premultiplied by opacity: the object over black
  core::FloatImage opacity;  // (H x W x 1)
};

// A loss on pictures of the object from cameras that the loss itself picks. Score distillation is
// one; a fit (of a radiance field, of a mesh) draws what is asked for and descends.
class PictureObjective {
 public:
  virtual ~PictureObjective() = default;

  // The camera of the next picture; `progress` in [0, 1) says how far the fit has come.
  virtual core::Camera NextCamera(double progress, core::Rng* rng) = 0;

  // The loss of `picture`, seen from `camera`; `gradient` becomes dL/d(picture), of its size.
  virtual double Evaluate(const core::Camera& camera, const ObjectPicture& picture, double progress,
                          core::Rng* rng, ObjectPicture* gradient) = 0;
};

}  // namespace simwright::asset_lift
