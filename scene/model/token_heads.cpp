#include "scene/model/token_heads.h"

#include <cmath>

#include "nn/blocks.h"
#include "scene/dataset/vocabulary.h"

namespace simwright::scene {
namespace {

using torch::nn::Linear;

constexpr int kTimeFeatures = 256;
constexpr std::int64_t kPlaceWidth = 3;

// (B x N x 12) -> (B x N x 12 + 6 octaves).
torch::Tensor WithOctaves(const torch::Tensor& poses, int octaves) {
  if (octaves == 0) return poses;
  std::vector<torch::Tensor> all{poses};
  torch::Tensor angle = M_PI * poses.narrow(-1, 0, kPlaceWidth);
  for (int k = 0; k < octaves; ++k, angle = 2.0 * angle) {
    all.push_back(torch::sin(angle));
    all.push_back(torch::cos(angle));
  }
  return torch::cat(all, -1);
}

}  // namespace

TokenEntryImpl::TokenEntryImpl(const SceneModelOptions& options, int classes, ClassShapes shapes)
    : octaves_(options.place_octaves), shapes_(std::move(shapes)) {
  const std::int64_t half = EntryWidth(options.width);
  const std::int64_t pose = kPoseWidth + 2 * kPlaceWidth * octaves_;
  pose_ = register_module(
      "pose", torch::nn::Sequential(Linear(pose, half), torch::nn::SiLU(), Linear(half, half)));
  if (options.continuous) {
    class_map_ = register_module("class_map", Linear(classes, half));
  } else if (!shapes_) {
    class_ = register_module("class", torch::nn::Embedding(classes + 1, half));
  }
  join_ = register_module("join", Linear(2 * half, options.width));
}

torch::Tensor TokenEntryImpl::forward(const NoisyScenes& scenes) {
  const torch::Tensor classes = class_map_ ? class_map_(scenes.classes)
                                : shapes_  ? torch::embedding(shapes_->Entries(), scenes.classes)
                                           : class_(scenes.classes);
  return join_(torch::cat({pose_->forward(WithOctaves(scenes.poses, octaves_)), classes}, -1));
}

TokenExitImpl::TokenExitImpl(std::int64_t width, int classes, ClassShapes shapes)
    : shapes_(std::move(shapes)) {
  pose_ = register_module("pose", torch::nn::Sequential(Linear(width, width), torch::nn::SiLU(),
                                                        Linear(width, kPoseWidth)));
  class_norm_ = register_module(
      "class_norm", torch::nn::LayerNorm(torch::nn::LayerNormOptions({width}).eps(1e-6)));
  if (!shapes_) class_map_ = register_module("class_map", Linear(width, classes));
}

Denoised TokenExitImpl::forward(const torch::Tensor& features) {
  // In single precision, whatever products are done in (nn::MixedPrecision).
  const torch::Tensor normed = class_norm_(features.to(torch::kFloat));
  return {pose_->forward(features), shapes_ ? shapes_->Logits(normed) : class_map_(normed)};
}

TimeEntryImpl::TimeEntryImpl(std::int64_t width) {
  map_ = register_module("map", torch::nn::Sequential(Linear(kTimeFeatures, width),
                                                      torch::nn::SiLU(), Linear(width, width)));
}

torch::Tensor TimeEntryImpl::forward(const torch::Tensor& time) {
  return map_->forward(nn::SinusoidalEmbedding(time, kTimeFeatures));
}

}  // namespace simwright::scene
