#pragma once

#include <vector>

#include "nn/torch.h"
#include "scene/prompt/class_limits.h"

namespace simwright::scene {

// Holds the sampling of a mixed diffusion to limits of the numbers of objects per class. A network
// predicts the class of each entry by itself, so that the numbers of a prompt are met on average at
// best. In each denoising step
//   1. the predicted probabilities are replaced by the closest ones, in the Kullback-Leibler
//      divergence, whose expected numbers are within the limits, and for each class without a
//      limit, such as furniture, but the empty one, as predicted (Tilt);
//   2. of the drawn classes those beyond a limit, and those that would leave too few entries for
//      what is missing, stay masked (Hold).
// The result is a sample of the conditional distribution if the classes of entries are independent
// and identically distributed.
class LimitedClasses {
 public:
  // `limits`: of each scene of a batch, none for a scene without. `classes`: K, with the empty one.
  LimitedClasses(std::vector<std::vector<ClassLimit>> limits, int classes);

  // Returns the tilted probabilities of clean classes (B x N x K), for `probabilities` and the
  // noisy classes (B x N, K is the mask). Those of entries that are not masked stay as they are.
  // Limits that exceed the masked entries are met as far as they go.
  torch::Tensor Tilt(const torch::Tensor& probabilities, const torch::Tensor& noisy) const;

  // Corrects the classes drawn in a step, (B x N): entries that were not masked before keep their
  // class. `tilted`: the probabilities; an entry draws from them again, among the classes that
  // are allowed, if it may not stay masked because the step is the last one.
  void Hold(const torch::Tensor& before, const torch::Tensor& tilted, bool last,
            const at::Generator& generator, torch::Tensor* drawn) const;

 private:
  struct SceneLimits {
    std::vector<ClassLimit> limits;
    std::vector<int> limit_of;  // (K): index in `limits`; -1: none
    // (K): index of the weight of a class; the limits' first, then those of other classes, then
    // that of the empty class, which is 1.
    std::vector<size_t> weight_of;
  };
  class Counter;

  void TiltScene(const SceneLimits& scene, const std::int64_t* noisy, std::int64_t entries,
                 float* probabilities) const;
  void HoldScene(const SceneLimits& scene, const std::int64_t* before, const float* tilted,
                 const float* uniform, bool last, std::int64_t entries, std::int64_t* drawn) const;

  std::vector<SceneLimits> scenes_;
  int classes_;
};

}  // namespace simwright::scene
