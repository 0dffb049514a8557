#pragma once

#include "nn/torch.h"
#include "scene/metrics/label_render.h"

namespace simwright::scene {

// Pictures as the network takes them, pixels.
inline constexpr int kFeatureWidth = 160, kFeatureHeight = 120;
// Numbers that stand for a picture.
inline constexpr int kFeatureSize = 128;
// What it learns to tell of each class: objects in all, and in each quarter of the picture (upper
// left, upper right, lower left, lower right), since counts alone say nothing of where things are.
inline constexpr int kCountsAClass = 5;

// A small convolutional network on label renders: patches of 4 x 4 pixels, three halvings of size,
// 32 to 96 channels with group norms, then two layers; what the first gives, after SiLU, are the
// features.
class FeatureNetworkImpl : public torch::nn::Module {
 public:
  FeatureNetworkImpl();
  // pictures (B x 3 x kFeatureHeight x kFeatureWidth), [0, 1] -> (B x kFeatureSize).
  torch::Tensor Features(const torch::Tensor& pictures);
  // -> (B x kMostLabels x kCountsAClass), log(1 + count).
  torch::Tensor forward(const torch::Tensor& pictures);

 private:
  torch::nn::Sequential convolutions_{nullptr};
  torch::nn::Linear features_{nullptr}, counts_{nullptr};
};
TORCH_MODULE(FeatureNetwork);

inline constexpr char kFeatureKind[] = "scene features";

// RGB pictures, all of one size -> (B x 3 x H x W), [0, 1].
torch::Tensor PictureTensor(const std::vector<core::Image>& pictures);

}  // namespace simwright::scene
