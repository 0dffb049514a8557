#include "scene/model/inpainting.h"

#include <algorithm>

#include "scene/model/token_tensors.h"

namespace simwright::scene {
namespace {

// Returns flags as a bool tensor of a shape.
torch::Tensor FlagTensor(const std::vector<char>& flags, at::IntArrayRef shape) {
  torch::Tensor tensor = torch::empty(shape, torch::kBool);
  std::transform(flags.begin(), flags.end(), tensor.data_ptr<bool>(),
                 [](char flag) { return flag != 0; });
  return tensor;
}

// Returns values first .. first + count - 1.
template <typename Value>
std::vector<Value> PartOfValues(const std::vector<Value>& all, size_t first, size_t count) {
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
  return std::vector<Value>(begin, begin + static_cast<std::ptrdiff_t>(count));
}

}  // namespace

KeptTokens::KeptTokens(const std::vector<float>& tokens, const InpaintingMask& mask, int first,
                       int count, const Vocabulary& vocabulary, const PoseRange& range,
                       torch::Device device)
    : width_(static_cast<size_t>(vocabulary.TokenWidth())), empty_class_(vocabulary.EmptyClass()) {
  const auto entries = static_cast<size_t>(vocabulary.entries);
  const size_t start = static_cast<size_t>(first) * entries;
  const size_t size = static_cast<size_t>(count) * entries;
  pose_ = PartOfValues(mask.pose, start, size);
  classes_ = PartOfValues(mask.classes, start, size);
  tokens_ = PartOfValues(tokens, start * width_, size * width_);
  const auto kept = [](const std::vector<char>& flags) {
    return std::find(flags.begin(), flags.end(), 0) != flags.end();
  };
  if (kept(pose_) || kept(classes_)) {
    clean_ = TensorsOf(tokens_, vocabulary, range);
    clean_.poses = clean_.poses.to(device);
    clean_.classes = clean_.classes.to(device);
    keep_poses_ = FlagTensor(pose_, {count, vocabulary.entries, 1}).logical_not().to(device);
    keep_classes_ = FlagTensor(classes_, {count, vocabulary.entries}).logical_not().to(device);
  }
  const torch::Tensor shut =
      FlagTensor(classes_, {count, vocabulary.entries})
          .logical_and(FlagTensor(pose_, {count, vocabulary.entries}).logical_not());
  if (mask.forbidden.empty() && !shut.any().item<bool>()) return;
  const auto classes = static_cast<size_t>(vocabulary.ClassCount());
  torch::Tensor forbidden =
      torch::zeros({count, vocabulary.entries, vocabulary.ClassCount()}, torch::kBool);
  if (!mask.forbidden.empty()) {
    forbidden = FlagTensor(PartOfValues(mask.forbidden, start * classes, size * classes),
                           forbidden.sizes());
  }
  forbidden.select(-1, empty_class_).logical_or_(shut);  // a kept pose is an object's
  forbidden_ = forbidden.to(device);
}

void KeptTokens::Clamp(const SceneDiffusion& diffusion, Clamping clamping, int t,
                       const at::Generator& generator, NoisyScenes* scenes) const {
  if (!keep_poses_.defined()) return;
  const bool noised = clamping == Clamping::kForwardNoised && t >= 0;
  const NoisyScenes known =
      noised ? diffusion.NoisyAt(clean_, t, generator) : diffusion.WithoutNoise(clean_);
  scenes->poses = torch::where(keep_poses_, known.poses, scenes->poses);
  const bool continuous = scenes->classes.dim() == 3;
  scenes->classes = torch::where(continuous ? keep_classes_.unsqueeze(-1) : keep_classes_,
                                 known.classes, scenes->classes);
}

void KeptTokens::Restore(std::vector<float>* sampled) const {
  for (size_t i = 0; i < pose_.size(); ++i) {
    const float* const from = &tokens_[i * width_];
    float* const to = &(*sampled)[i * width_];
    if (classes_[i] == 0) std::copy(from + kPoseWidth, from + width_, to + kPoseWidth);
    const bool kept_empty =
        classes_[i] == 0 && from[kPoseWidth + static_cast<size_t>(empty_class_)] == 1.0f;
    if (pose_[i] == 0 || kept_empty) std::copy(from, from + kPoseWidth, to);
  }
}

}  // namespace simwright::scene
