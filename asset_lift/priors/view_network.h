#pragma once

#include <vector>

#include "asset_lift/priors/shape_prior.h"
#include "asset_lift/priors/view_prior.h"
#include "nn/torch.h"
#include "nn/unet.h"

namespace simwright::asset_lift {

inline constexpr int kViewSide = 64;  // pixels per side of our view prior's images
inline constexpr int kViewDiffusionSteps = 1000;

struct ViewNetworkOptions {
  std::vector<int> channels = {32, 64, 96, 128};
  int embedding = 128;
};

// The network that predicts the noise in an image (RGBA in [-1, 1], premultiplied) from another
// camera. Its inputs are the noisy image, the shape prior's prediction rendered from that camera
// (aligned pixel by pixel, at no cost in learning), and the reference photo.
class ViewNetworkImpl : public torch::nn::Module {
 public:
  explicit ViewNetworkImpl(const ViewNetworkOptions& options = {});

  // Predicts the noise. noisy (B x 4 x S x S), rendered (B x 5 x S x S), taken (B x 4 x S x S),
  // camera (B x 5), t (B).
  torch::Tensor forward(const torch::Tensor& noisy, const torch::Tensor& rendered,
                        const torch::Tensor& taken, const torch::Tensor& camera,
                        const torch::Tensor& t);

 private:
  int embedding_;
  nn::UNet body_{nullptr};
  torch::nn::Linear time_{nullptr}, camera_{nullptr}, mixed_{nullptr};
};
TORCH_MODULE(ViewNetwork);

// Returns a fit's rendering as a (1 x 4 x S x S) tensor in [-1, 1].
torch::Tensor PictureTensor(const ObjectImage& picture);
// Returns a (1 x 5 x S x S) tensor: the prediction's colour and opacity in [-1, 1], and its depth
// relative to the object's centre in units of the object's radius.
torch::Tensor PredictionTensor(const RenderedPrediction& rendered, const core::Camera& camera,
                               double radius);
// Returns a (1 x 5) tensor: the relative elevation, sine and cosine of the azimuth, and distance,
// and the elevation of the reference.
torch::Tensor CameraTensor(const core::Camera& reference, const core::Camera& camera);

}  // namespace simwright::asset_lift
