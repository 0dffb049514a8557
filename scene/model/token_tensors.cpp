#include "scene/model/token_tensors.h"

#include <algorithm>

namespace simwright::scene {

CleanScenes TensorsOf(const std::vector<float>& tokens, const Vocabulary& vocabulary,
                      const PoseRange& range) {
  const auto width = static_cast<size_t>(vocabulary.TokenWidth());
  const size_t count = tokens.size() / width;
  const auto entries = static_cast<std::int64_t>(vocabulary.entries);
  const std::int64_t scenes = static_cast<std::int64_t>(count) / entries;
  CleanScenes clean{torch::empty({scenes, entries, kPoseWidth}, torch::kFloat),
                    torch::empty({scenes, entries}, torch::kLong)};
  float* const poses = clean.poses.data_ptr<float>();
  std::int64_t* const classes = clean.classes.data_ptr<std::int64_t>();
  for (size_t i = 0; i < count; ++i) {
    const float* const token = &tokens[i * width];
    range.ToUnit(token, poses + i * kPoseWidth);
    classes[i] = std::max_element(token + kPoseWidth, token + width) - (token + kPoseWidth);
  }
  return clean;
}

std::vector<float> TokensOf(const CleanScenes& scenes, const Vocabulary& vocabulary,
                            const PoseRange& range) {
  const torch::Tensor pose_tensor = scenes.poses.to(torch::kCPU, torch::kFloat).contiguous();
  const torch::Tensor class_tensor = scenes.classes.to(torch::kCPU).contiguous();
  const float* const poses = pose_tensor.data_ptr<float>();
  const std::int64_t* const classes = class_tensor.data_ptr<std::int64_t>();
  const auto width = static_cast<size_t>(vocabulary.TokenWidth());
  const auto count = static_cast<size_t>(class_tensor.numel());
  std::vector<float> tokens(count * width, 0.0f);
  for (size_t i = 0; i < count; ++i) {
    float* const token = &tokens[i * width];
    token[kPoseWidth + classes[i]] = 1.0f;
    if (classes[i] != vocabulary.EmptyClass()) range.FromUnit(poses + i * kPoseWidth, token);
  }
  return tokens;
}

}  // namespace simwright::scene
