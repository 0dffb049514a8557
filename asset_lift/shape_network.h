#pragma once

#include "nn/torch.h"
#include "nn/unet.h"

namespace simwright::asset_lift {

// What the shape network says of a batch of crops.
struct ShapeNetworkOutput {
  torch::Tensor occupancy;  // (B x kDepthCells x side x side) logits, nearest w first
  torch::Tensor back;       // (B x 3 x side x side) sRGB of the hidden side, about [0, 1]
  torch::Tensor elevation;  // (B x 2): rad, and the logarithm of its deviation (Laplace's b)
};

struct ShapeNetworkOptions {
  std::vector<int> channels = {48, 96, 192, 256};
  int blocks = 1;
};

// From one crop to the whole block of space behind it: a U-Net whose output channels are the depth
// cells of each pixel, so that the outline is kept by its skips and the depth is free (as the
// voxel tubes of Richter and Roth 2018 and pixel-aligned fields do).
class ShapeNetworkImpl : public torch::nn::Module {
 public:
  explicit ShapeNetworkImpl(const ShapeNetworkOptions& options = {});

  // pictures (B x 4 x side x side): RGB in [-1, 1] times alpha, and alpha.
  ShapeNetworkOutput forward(const torch::Tensor& pictures);

 private:
  nn::UNet body_{nullptr};
  torch::nn::Linear elevation_hidden_{nullptr}, elevation_{nullptr};
};
TORCH_MODULE(ShapeNetwork);

// (count x 4 x side x side) network input from RGBA bytes (count x side x side x 4).
torch::Tensor PicturesFromRgba(const std::uint8_t* rgba, int count, int side);

}  // namespace simwright::asset_lift
