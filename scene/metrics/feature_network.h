#pragma once

#include "nn/torch.h"
#include "scene/metrics/label_render.h"

namespace simwright::scene {

// The size of the network's input images, pixels.
inline constexpr int kFeatureWidth = 160, kFeatureHeight = 120;
// The number of features of an image.
inline constexpr int kFeatureSize = 128;
// The counts that it learns per class: objects in total, and in each quadrant of the image (upper
// left, upper right, lower left, lower right), because totals alone contain no positions.
inline constexpr int kCountsPerClass = 5;

// A small convolutional network on label renders: patches of 4 x 4 pixels, three downsamplings by
// two, 32 to 96 channels with group norms, then two linear layers; the features are the output of
// the first after SiLU.
class FeatureNetworkImpl : public torch::nn::Module {
 public:
  FeatureNetworkImpl();
  // Returns the features (B x kFeatureSize) of images (B x 3 x kFeatureHeight x kFeatureWidth) in
  // [0, 1].
  torch::Tensor Features(const torch::Tensor& pictures);
  // Returns log(1 + count), (B x kMaxLabels x kCountsPerClass).
  torch::Tensor forward(const torch::Tensor& pictures);

 private:
  torch::nn::Sequential convolutions_{nullptr};
  torch::nn::Linear features_{nullptr}, counts_{nullptr};
};
TORCH_MODULE(FeatureNetwork);

inline constexpr char kFeatureKind[] = "scene features";

// Returns RGB images of one size as a tensor (B x 3 x H x W) in [0, 1].
torch::Tensor PictureTensor(const std::vector<core::Image>& pictures);

}  // namespace simwright::scene
