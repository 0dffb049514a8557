#include "scene/metrics/feature_network.h"

#include "core/error.h"

namespace simwright::scene {
namespace {

constexpr int kPatch = 4;  // pixels per side of a patch of the first convolution
constexpr int kChannels[] = {32, 48, 64, 96};
constexpr int kGroup = 8;  // channels per norm group
// The output size of the last convolution: 160 x 120 divided by 4, then halved three times, rounded
// up.
constexpr int kLastWidth = 5, kLastHeight = 4;

}  // namespace

FeatureNetworkImpl::FeatureNetworkImpl() {
  convolutions_ = torch::nn::Sequential();
  int in = 3;
  for (const int out : kChannels) {
    const torch::nn::Conv2dOptions size =
        in == 3 ? torch::nn::Conv2dOptions(in, out, kPatch).stride(kPatch)
                : torch::nn::Conv2dOptions(in, out, 3).stride(2).padding(1);
    convolutions_->push_back(torch::nn::Conv2d(size));
    convolutions_->push_back(torch::nn::GroupNorm(torch::nn::GroupNormOptions(out / kGroup, out)));
    convolutions_->push_back(torch::nn::SiLU());
    in = out;
  }
  register_module("convolutions", convolutions_);
  features_ =
      register_module("features", torch::nn::Linear(in * kLastWidth * kLastHeight, kFeatureSize));
  counts_ =
      register_module("counts", torch::nn::Linear(kFeatureSize, kMaxLabels * kCountsPerClass));
}

torch::Tensor FeatureNetworkImpl::Features(const torch::Tensor& pictures) {
  const torch::Tensor last = convolutions_->forward(2.0 * pictures - 1.0);
  return torch::silu(features_->forward(last.flatten(1)));
}

torch::Tensor FeatureNetworkImpl::forward(const torch::Tensor& pictures) {
  return counts_->forward(Features(pictures)).view({-1, kMaxLabels, kCountsPerClass});
}

torch::Tensor PictureTensor(const std::vector<core::Image>& pictures) {
  if (pictures.empty()) throw core::Error("there are no images");
  const core::Image& first = pictures.front();
  std::vector<torch::Tensor> rows;
  for (const core::Image& one : pictures) {
    if (one.channels != 3 || one.width != first.width || one.height != first.height) {
      throw core::Error("the images of a batch must be RGB and of one size");
    }
    rows.push_back(torch::from_blob(const_cast<std::uint8_t*>(one.pixels.data()),
                                    {one.height, one.width, 3}, torch::kUInt8));
  }
  return torch::stack(rows).permute({0, 3, 1, 2}).to(torch::kFloat32).div(255.0).contiguous();
}

}  // namespace simwright::scene
