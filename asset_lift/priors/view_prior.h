#pragma once

#include <memory>
#include <vector>

#include "asset_lift/camera/view_frame.h"
#include "core/camera.h"
#include "core/image.h"
#include "nn/diffusion_schedule.h"
#include "nn/torch.h"

namespace simwright::asset_lift {

// The reference photo of a view prior.
struct ReferenceView {
  ViewFrame frame;    // the crop and the reference camera
  core::Image photo;  // RGB or RGBA, of frame.camera's image size
  core::Image alpha;  // 1 channel, same size: the object's matte
};

// A camera relative to the reference camera, both looking at the object at the origin of a world
// with z up.
struct RelativeCamera {
  double elevation = 0.0;  // rad, of this camera minus that of the reference
  double azimuth = 0.0;    // rad in (-pi, pi], about z
  double distance = 0.0;   // this camera's distance over the reference's, minus 1
};
RelativeCamera RelativeTo(const core::Camera& reference, const core::Camera& camera);

// A view-conditioned diffusion model of images of one object: predicts the noise in a noisy image
// from another camera, given the reference photo and that camera's relative pose.
class ViewPrior {
 public:
  virtual ~ViewPrior() = default;

  // Returns the pixels per side of its images.
  virtual int side() const = 0;
  virtual const nn::DiffusionSchedule& schedule() const = 0;

  // Sets the object of the following calls.
  virtual void SetReference(const ReferenceView& view) = 0;

  // Encodes images (B x 4 x side x side), RGB premultiplied by alpha and alpha, in [0, 1], to the
  // space of the noise (B x C x h x w), differentiably. Pixel models rescale; latent models encode.
  virtual torch::Tensor Encode(const torch::Tensor& pictures) = 0;

  // Predicts the noise in `noisy` (B x C x h x w) at t (B, int64), seen by `cameras` (B). If not
  // `conditioned`, the reference is ignored, for classifier-free guidance (Ho and Salimans 2022).
  virtual torch::Tensor PredictNoise(const torch::Tensor& noisy, const torch::Tensor& t,
                                     const std::vector<core::Camera>& cameras,
                                     bool conditioned) = 0;
};

}  // namespace simwright::asset_lift
