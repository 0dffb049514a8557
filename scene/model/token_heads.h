#pragma once

#include "scene/model/class_shapes.h"
#include "scene/model/denoiser.h"
#include "scene/model/pose_schedule.h"

namespace simwright::scene {

// The input and output heads of all denoisers: tokens to features and back.

// The input head: an MLP of two layers on the pose, an embedding of the class (a linear map if
// classes are continuous), and a linear map of both to the width. With `shapes`, a module
// registered in the same denoiser with the entry width EntryWidth(width), it embeds the classes.
class TokenInputHeadImpl : public torch::nn::Module {
 public:
  TokenInputHeadImpl(const SceneModelOptions& options, int classes, ClassShapes shapes = nullptr);
  torch::Tensor forward(const NoisyScenes& scenes);  // (B x N x width)

 private:
  ClassShapes shapes_{nullptr};
  torch::nn::Sequential pose_{nullptr};
  torch::nn::Embedding class_{nullptr};
  torch::nn::Linear class_map_{nullptr}, join_{nullptr};
};
TORCH_MODULE(TokenInputHead);

constexpr std::int64_t EntryWidth(std::int64_t width) {
  return width / 2;
}

// The noise of poses x = a x_0 + s e from predictions of both e and x_0,
//   e' + g (x - a x_0') / s,  with a predicted gate 0 < g < 1.
// With e' alone, a known height (a table top) differs from an unknown one by a slope of 1 / s, a
// hundred at the least noise, which is learned last (docs/scenes.md has figures). x_0' is a step
// function that is flat there.
class PoseBlend {
 public:
  explicit PoseBlend(const SceneModelOptions& options)
      : wanted_(options.blends_clean_poses), schedule_(PoseSchedule(options.diffusion_steps)) {}
  // Returns the number of network outputs per token: 12, or 36 for e', x_0' and the gates.
  std::int64_t Width() const;
  // Returns the noise (B x N x 12) of predictions (B x N x Width()).
  torch::Tensor Noise(const torch::Tensor& guesses, const NoisyScenes& scenes) const;

 private:
  bool wanted_;
  nn::DiffusionSchedule schedule_;
};

// The output heads: an MLP of two layers for the pose noise, and a norm with a linear map, or
// `shapes`, for the class. If the options ask for it, the first gives the inputs of PoseBlend.
class TokenOutputHeadImpl : public torch::nn::Module {
 public:
  // `width`: width of the input features.
  TokenOutputHeadImpl(const SceneModelOptions& options, std::int64_t width, int classes,
                      ClassShapes shapes = nullptr);
  // pose_noise: (B x N x 12).
  Denoised forward(const torch::Tensor& features, const NoisyScenes& scenes);

 private:
  PoseBlend blend_;
  ClassShapes shapes_{nullptr};
  torch::nn::Sequential pose_{nullptr};
  torch::nn::LayerNorm class_norm_{nullptr};
  torch::nn::Linear class_map_{nullptr};
};
TORCH_MODULE(TokenOutputHead);

// An embedding of the time: sines and cosines of 256 / 2 frequencies through two layers.
class TimeEmbeddingImpl : public torch::nn::Module {
 public:
  explicit TimeEmbeddingImpl(std::int64_t width);
  torch::Tensor forward(const torch::Tensor& time);  // (B) -> (B x width)

 private:
  torch::nn::Sequential map_{nullptr};
};
TORCH_MODULE(TimeEmbedding);

}  // namespace simwright::scene
