#include "scene/model/token_heads.h"

#include "nn/blocks.h"
#include "scene/dataset/vocabulary.h"

namespace simwright::scene {
namespace {

using torch::nn::Linear;

constexpr int kTimeFeatures = 256;

}  // namespace

TokenInputHeadImpl::TokenInputHeadImpl(const SceneModelOptions& options, int classes,
                                       ClassShapes shapes)
    : shapes_(std::move(shapes)) {
  const std::int64_t half = EntryWidth(options.width);
  pose_ = register_module("pose", torch::nn::Sequential(Linear(kPoseWidth, half), torch::nn::SiLU(),
                                                        Linear(half, half)));
  if (options.continuous) {
    class_map_ = register_module("class_map", Linear(classes, half));
  } else if (!shapes_) {
    class_ = register_module("class", torch::nn::Embedding(classes + 1, half));
  }
  join_ = register_module("join", Linear(2 * half, options.width));
}

torch::Tensor TokenInputHeadImpl::forward(const NoisyScenes& scenes) {
  const torch::Tensor classes = class_map_ ? class_map_(scenes.classes)
                                : shapes_
                                    ? torch::embedding(shapes_->InputEmbeddings(), scenes.classes)
                                    : class_(scenes.classes);
  return join_(torch::cat({pose_->forward(scenes.poses), classes}, -1));
}

std::int64_t PoseBlend::Width() const {
  return wanted_ ? 3 * kPoseWidth : kPoseWidth;
}

torch::Tensor PoseBlend::Noise(const torch::Tensor& guesses, const NoisyScenes& scenes) const {
  if (!wanted_) return guesses;
  // g starts near zero: initially x_0' has large errors, which are divided by a factor down to a
  // hundredth.
  constexpr double kGateStart = -4.0;
  const std::vector<torch::Tensor> parts = guesses.to(torch::kFloat).chunk(3, -1);
  const torch::Tensor off = (scenes.poses - schedule_.Signal(scenes.time, 3) * parts[1]) /
                            schedule_.Noise(scenes.time, 3);
  return parts[0] + torch::sigmoid(parts[2] + kGateStart) * off;
}

TokenOutputHeadImpl::TokenOutputHeadImpl(const SceneModelOptions& options, std::int64_t width,
                                         int classes, ClassShapes shapes)
    : blend_(options), shapes_(std::move(shapes)) {
  pose_ = register_module("pose", torch::nn::Sequential(Linear(width, width), torch::nn::SiLU(),
                                                        Linear(width, blend_.Width())));
  class_norm_ = register_module(
      "class_norm", torch::nn::LayerNorm(torch::nn::LayerNormOptions({width}).eps(1e-6)));
  if (!shapes_) class_map_ = register_module("class_map", Linear(width, classes));
}

Denoised TokenOutputHeadImpl::forward(const torch::Tensor& features, const NoisyScenes& scenes) {
  // In single precision even under nn::MixedPrecision.
  const torch::Tensor normed = class_norm_(features.to(torch::kFloat));
  return {blend_.Noise(pose_->forward(features), scenes),
          shapes_ ? shapes_->Logits(normed) : class_map_(normed)};
}

TimeEmbeddingImpl::TimeEmbeddingImpl(std::int64_t width) {
  map_ = register_module("map", torch::nn::Sequential(Linear(kTimeFeatures, width),
                                                      torch::nn::SiLU(), Linear(width, width)));
}

torch::Tensor TimeEmbeddingImpl::forward(const torch::Tensor& time) {
  return map_->forward(nn::SinusoidalEmbedding(time, kTimeFeatures));
}

}  // namespace simwright::scene
