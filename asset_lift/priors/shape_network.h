#pragma once

#include <filesystem>
#include <vector>

#include "nn/checkpoint.h"
#include "nn/torch.h"
#include "nn/unet.h"

namespace simwright::asset_lift {

// The shape network's output for a batch of crops.
struct ShapeNetworkOutput {
  torch::Tensor occupancy;  // (B x kDepthCells x side x side) logits, nearest w first
  torch::Tensor back;       // (B x 3 x side x side) sRGB of the hidden side, about [0, 1]
  torch::Tensor elevation;  // (B x 2): rad, and the logarithm of its deviation (Laplace's b)
};

struct ShapeNetworkOptions {
  std::vector<int> channels = {48, 96, 192, 256};
  int blocks = 1;

  // Returns the options as metadata of a weights file.
  nn::CheckpointMetadata Metadata() const;
  // Returns the options of a weights file; the defaults where it names none. Throws core::Error for
  // a file that is missing, damaged or of another kind, or for sizes that no network can have.
  static ShapeNetworkOptions Of(const std::filesystem::path& weights);
};

// Maps one crop to the block of space behind it: a U-Net whose output channels are the depth cells
// of each pixel. Its skip connections preserve the silhouette and the depth is unconstrained (as in
// the voxel tubes of Richter and Roth 2018 and pixel-aligned fields).
class ShapeNetworkImpl : public torch::nn::Module {
 public:
  explicit ShapeNetworkImpl(const ShapeNetworkOptions& options = {});

  // `pictures` (B x 4 x side x side): RGB in [-1, 1] times alpha, and alpha.
  ShapeNetworkOutput forward(const torch::Tensor& pictures);

 private:
  nn::UNet body_{nullptr};
  torch::nn::Linear elevation_hidden_{nullptr}, elevation_{nullptr};
};
TORCH_MODULE(ShapeNetwork);

// Returns the (count x 4 x side x side) network input for RGBA bytes (count x side x side x 4).
torch::Tensor PicturesFromRgba(const std::uint8_t* rgba, int count, int side);

}  // namespace simwright::asset_lift
