#pragma once

#include "scene/model/class_shapes.h"
#include "scene/model/denoiser.h"

namespace simwright::scene {

// Tokens into a network's features and back, the same for every denoiser.

// A network of two layers on the pose, an embedding of the class (a linear map of it where classes
// are numbers), and a linear map of both to the width. Beside the pose enter sin and cos(2^k pi p)
// of each coordinate p of the place, in [-1, 1], for k below `place_octaves`. With `shapes`, which
// has to be a module of the same denoiser and enter by EntryWidth(width), it embeds classes.
class TokenEntryImpl : public torch::nn::Module {
 public:
  TokenEntryImpl(const SceneModelOptions& options, int classes, ClassShapes shapes = nullptr);
  torch::Tensor forward(const NoisyScenes& scenes);  // (B x N x width)

 private:
  int octaves_;
  ClassShapes shapes_{nullptr};
  torch::nn::Sequential pose_{nullptr};
  torch::nn::Embedding class_{nullptr};
  torch::nn::Linear class_map_{nullptr}, join_{nullptr};
};
TORCH_MODULE(TokenEntry);

constexpr std::int64_t EntryWidth(std::int64_t width) {
  return width / 2;
}

// Two heads: a network of two layers for the pose's noise, a norm and a linear map, or `shapes`,
// for the class.
class TokenExitImpl : public torch::nn::Module {
 public:
  TokenExitImpl(std::int64_t width, int classes, ClassShapes shapes = nullptr);
  Denoised forward(const torch::Tensor& features);

 private:
  ClassShapes shapes_{nullptr};
  torch::nn::Sequential pose_{nullptr};
  torch::nn::LayerNorm class_norm_{nullptr};
  torch::nn::Linear class_map_{nullptr};
};
TORCH_MODULE(TokenExit);

// Time as a vector: sines and cosines of 256 / 2 frequencies through two layers.
class TimeEntryImpl : public torch::nn::Module {
 public:
  explicit TimeEntryImpl(std::int64_t width);
  torch::Tensor forward(const torch::Tensor& time);  // (B) -> (B x width)

 private:
  torch::nn::Sequential map_{nullptr};
};
TORCH_MODULE(TimeEntry);

}  // namespace simwright::scene
