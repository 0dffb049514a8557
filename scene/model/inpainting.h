#pragma once

#include <vector>

#include "scene/dataset/pose_range.h"
#include "scene/model/inpainting_mask.h"
#include "scene/model/scene_diffusion.h"

namespace simwright::scene {

// A batch of scenes of which a part is kept: holds noisy scenes to it during sampling.
class KeptTokens {
 public:
  // `tokens` (B x entries x TokenWidth) and `mask`: scenes first .. first + count - 1 of them.
  KeptTokens(const std::vector<float>& tokens, const InpaintingMask& mask, int first, int count,
             const Vocabulary& vocabulary, const PoseRange& range, torch::Device device);

  // Sets the kept values of noisy scenes at t; -1: to the clean values.
  void Clamp(const SceneDiffusion& diffusion, Clamping clamping, int t,
             const at::Generator& generator, NoisyScenes* scenes) const;

  // Returns the forbidden classes (B x N x K, bool); undefined: none.
  const torch::Tensor& forbidden() const { return forbidden_; }

  // Copies the kept values, bit by bit, into the tokens of the sampled scenes. An entry whose class
  // is kept and empty keeps its pose, too.
  void Restore(std::vector<float>* sampled) const;

 private:
  std::vector<float> tokens_;  // of this batch
  std::vector<char> pose_, classes_;
  size_t width_;
  int empty_class_;
  CleanScenes clean_;
  torch::Tensor keep_poses_, keep_classes_;  // (B x N x 1), (B x N), bool; undefined: none is kept
  torch::Tensor forbidden_;
};

}  // namespace simwright::scene
