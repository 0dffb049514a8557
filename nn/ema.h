#pragma once

#include <vector>

#include "nn/tensor_file.h"
#include "nn/torch.h"

namespace simwright::nn {

// Exponential moving average of a module's parameters: what is kept after training.
class Ema {
 public:
  // `decay` in [0, 1): the share of the average that a step keeps once warm; before, (1 + n) /
  // (10 + n) after n steps, so that the random start is forgotten.
  Ema(const torch::nn::Module& module, double decay);
  void Update(const torch::nn::Module& module);
  // Writes the average into the module's parameters.
  void CopyTo(torch::nn::Module* module) const;

  // All of it as tensors, and back. Load returns false where they are another module's.
  void Collect(NamedTensors* tensors) const;
  bool Load(const NamedTensors& tensors);

 private:
  double decay_;
  long updates_ = 0;
  std::vector<torch::Tensor> average_;
};

}  // namespace simwright::nn
