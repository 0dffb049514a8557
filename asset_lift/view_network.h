#pragma once

#include <vector>

#include "asset_lift/shape_prior.h"
#include "asset_lift/view_prior.h"
#include "nn/torch.h"
#include "nn/unet.h"

namespace simwright::asset_lift {

inline constexpr int kViewSide = 64;  // pixels of the pictures of our view prior
inline constexpr int kViewDiffusionSteps = 1000;

struct ViewNetworkOptions {
  std::vector<int> channels = {32, 64, 96, 128};
  int embedding = 128;
};

// Predicts the noise in a picture (RGBA in [-1, 1], premultiplied) from another camera. It sees,
// beside the noisy picture, the shape prior's prediction drawn from that camera (what direct
// prediction gives for nothing, aligned pixel by pixel), and the picture that was taken.
class ViewNetworkImpl : public torch::nn::Module {
 public:
  explicit ViewNetworkImpl(const ViewNetworkOptions& options = {});

  // noisy (B x 4 x S x S), drawn (B x 5 x S x S), taken (B x 4 x S x S), camera (B x 5), t (B).
  torch::Tensor forward(const torch::Tensor& noisy, const torch::Tensor& drawn,
                        const torch::Tensor& taken, const torch::Tensor& camera,
                        const torch::Tensor& t);

 private:
  int embedding_;
  nn::UNet body_{nullptr};
  torch::nn::Linear time_{nullptr}, camera_{nullptr}, mixed_{nullptr};
};
TORCH_MODULE(ViewNetwork);

// (1 x 4 x S x S) in [-1, 1] of a picture as a fit shows it.
torch::Tensor PictureTensor(const ObjectPicture& picture);
// (1 x 5 x S x S): the prediction's colour and opacity in [-1, 1], and its depth about the object's
// middle in units of the object's radius.
torch::Tensor DrawnTensor(const PredictionPicture& drawn, const core::Camera& camera,
                          double radius);
// (1 x 5): elevation, sine and cosine of the azimuth, distance, all relative, and the elevation of
// the reference.
torch::Tensor CameraTensor(const core::Camera& reference, const core::Camera& camera);

}  // namespace simwright::asset_lift
