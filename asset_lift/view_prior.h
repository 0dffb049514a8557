#pragma once

#include <memory>
#include <vector>

#include "asset_lift/view_frame.h"
#include "core/camera.h"
#include "core/image.h"
#include "nn/diffusion_schedule.h"
#include "nn/torch.h"

namespace simwright::asset_lift {

// The picture that was taken, as a view prior is told of it.
struct ReferenceView {
  ViewFrame frame;    // where the crop lies and what camera took it
  core::Image photo;  // RGB or RGBA, as large as frame.camera's picture
  core::Image alpha;  // 1 channel, likewise: the object's matte
};

// A camera as seen from the reference camera, both looking at the object at the origin of a world
// with z up.
struct RelativeCamera {
  double elevation = 0.0;  // rad, of this camera minus that of the reference
  double azimuth = 0.0;    // rad in (-pi, pi], about z
  double distance = 0.0;   // this camera's distance over the reference's, minus 1
};
RelativeCamera RelativeTo(const core::Camera& reference, const core::Camera& camera);

// A view-conditioned diffusion model of pictures of one object: given the picture that was taken
// and where another camera stands, the noise in a noisy picture from there.
class ViewPrior {
 public:
  virtual ~ViewPrior() = default;

  // Pixels a side of the pictures it sees.
  virtual int side() const = 0;
  virtual const nn::DiffusionSchedule& schedule() const = 0;

  // The object that the next calls are about.
  virtual void SetReference(const ReferenceView& view) = 0;

  // What is noised: from pictures (B x 4 x side x side), RGB premultiplied by alpha and alpha, in
  // [0, 1], to (B x C x h x w), differentiable. Pixel models rescale; latent models encode.
  virtual torch::Tensor Encode(const torch::Tensor& pictures) = 0;

  // The noise in `noisy` (B x C x h x w) at t (B, int64), seen by `cameras` (B). Not conditioned:
  // as if nothing were known of the object, for classifier-free guidance (Ho and Salimans 2022).
  virtual torch::Tensor PredictNoise(const torch::Tensor& noisy, const torch::Tensor& t,
                                     const std::vector<core::Camera>& cameras,
                                     bool conditioned) = 0;
};

}  // namespace simwright::asset_lift
