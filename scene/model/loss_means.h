#pragma once

#include <vector>

#include "scene/model/loss_records.h"
#include "scene/model/scene_diffusion.h"

namespace simwright::scene {

// The means of the losses of updates, for a line of the training log.
class LossMeans {
 public:
  // Adds an update's loss, the sum of the losses of its parts, each times its share.
  void Add(const std::vector<SceneLoss>& losses, const std::vector<double>& shares);
  // Adds an update's terms (5), as TermsOf returns them, on their device: reads nothing back. Terms
  // whose total is not finite count as no update.
  void AddOnDevice(const torch::Tensor& terms);
  // Returns the means, NaN if there are none, and begins again.
  LossRecord Take(int step);

 private:
  LossRecord sums_;
  int count_ = 0;
  torch::Tensor device_sums_;  // (6): terms and updates; undefined: none
};

// Returns the terms of a loss as (5), without gradients: total, translation, rotation, divergence,
// cross-entropy.
torch::Tensor TermsOf(const SceneLoss& loss);

}  // namespace simwright::scene
