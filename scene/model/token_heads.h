#pragma once

#include "scene/model/class_shapes.h"
#include "scene/model/denoiser.h"
#include "scene/model/pose_schedule.h"

namespace simwright::scene {

// Tokens into a network's features and back, the same for every denoiser.

// A network of two layers on the pose, an embedding of the class (a linear map of it where classes
// are numbers), and a linear map of both to the width. With `shapes`, which has to be a module of
// the same denoiser and enter by EntryWidth(width), it embeds classes.
class TokenEntryImpl : public torch::nn::Module {
 public:
  TokenEntryImpl(const SceneModelOptions& options, int classes, ClassShapes shapes = nullptr);
  torch::Tensor forward(const NoisyScenes& scenes);  // (B x N x width)

 private:
  ClassShapes shapes_{nullptr};
  torch::nn::Sequential pose_{nullptr};
  torch::nn::Embedding class_{nullptr};
  torch::nn::Linear class_map_{nullptr}, join_{nullptr};
};
TORCH_MODULE(TokenEntry);

constexpr std::int64_t EntryWidth(std::int64_t width) {
  return width / 2;
}

// The noise of poses x = a x_0 + s e from a network's guesses at both e and x_0,
//   e' + g (x - a x_0') / s,  0 < g < 1 a guess too.
// With e' alone, what tells a height that is known (a table's top) from one that is not is a slope
// of 1 / s, a hundred where the noise is least, and is learned last (docs/scenes.md has figures).
// x_0' is a step that is flat there.
class PoseBlend {
 public:
  explicit PoseBlend(const SceneModelOptions& options)
      : wanted_(options.blends_clean_poses), schedule_(PoseSchedule(options.diffusion_steps)) {}
  // Numbers a token that the network has to give: 12, or e', x_0' and g's, 36.
  std::int64_t Width() const;
  // (B x N x Width()) -> (B x N x 12).
  torch::Tensor Noise(const torch::Tensor& guesses, const NoisyScenes& scenes) const;

 private:
  bool wanted_;
  nn::DiffusionSchedule schedule_;
};

// Two heads: a network of two layers for the pose's noise, a norm and a linear map, or `shapes`,
// for the class. Where the options say so, the first gives what PoseBlend takes.
class TokenExitImpl : public torch::nn::Module {
 public:
  // `width` of the features that come in.
  TokenExitImpl(const SceneModelOptions& options, std::int64_t width, int classes,
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
