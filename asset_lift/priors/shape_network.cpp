#include "asset_lift/priors/shape_network.h"

#include "asset_lift/priors/shape_example.h"

namespace simwright::asset_lift {

ShapeNetworkImpl::ShapeNetworkImpl(const ShapeNetworkOptions& options) {
  nn::UNetOptions body;
  body.in_channels = 4;
  body.out_channels = kDepthCells + 3;
  body.channels = options.channels;
  body.blocks = options.blocks;
  body_ = register_module("body", nn::UNet(body));
  elevation_hidden_ =
      register_module("elevation_hidden", torch::nn::Linear(options.channels.back(), 64));
  elevation_ = register_module("elevation", torch::nn::Linear(64, 2));
}

ShapeNetworkOutput ShapeNetworkImpl::forward(const torch::Tensor& pictures) {
  torch::Tensor bottleneck;
  const torch::Tensor maps = body_->ForwardWithBottleneck(pictures, {}, &bottleneck);
  ShapeNetworkOutput output;
  output.occupancy = maps.slice(1, 0, kDepthCells);
  output.back = maps.slice(1, kDepthCells, kDepthCells + 3) + 0.5;
  output.elevation = elevation_(torch::silu(elevation_hidden_(bottleneck)));
  return output;
}

torch::Tensor PicturesFromRgba(const std::uint8_t* rgba, int count, int side) {
  const torch::Tensor bytes =
      torch::from_blob(const_cast<std::uint8_t*>(rgba), {count, side, side, 4}, torch::kUInt8)
          .permute({0, 3, 1, 2})
          .to(torch::kFloat)
          .div(255.0);
  const torch::Tensor alpha = bytes.slice(1, 3, 4);
  return torch::cat({(2.0 * bytes.slice(1, 0, 3) - 1.0) * alpha, alpha}, 1).contiguous();
}

}  // namespace simwright::asset_lift
