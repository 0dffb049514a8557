#include "asset_lift/priors/shape_network.h"

#include <cstdlib>
#include <sstream>
#include <string>

#include "asset_lift/priors/shape_example.h"
#include "core/error.h"

namespace simwright::asset_lift {

nn::CheckpointMetadata ShapeNetworkOptions::Metadata() const {
  std::string list;
  for (const int count : channels) list += (list.empty() ? "" : ",") + std::to_string(count);
  return {{"channels", list}};
}

ShapeNetworkOptions ShapeNetworkOptions::Of(const std::filesystem::path& weights) {
  const nn::CheckpointMetadata metadata = nn::ReadCheckpointMetadata(weights, "shape");
  ShapeNetworkOptions options;
  const auto found = metadata.find("channels");
  if (found == metadata.end()) return options;
  options.channels.clear();
  std::istringstream list(found->second);
  for (std::string count; std::getline(list, count, ',');) {
    const int channels = std::atoi(count.c_str());
    if (channels < 8 || channels > 4096 || channels % 8 != 0) {
      throw core::Error("the weights name channels that no network can have: " + found->second,
                        weights.string());
    }
    options.channels.push_back(channels);
  }
  if (options.channels.empty() || options.channels.size() > 6) {
    throw core::Error("the weights name no channels of one to six levels", weights.string());
  }
  return options;
}

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
