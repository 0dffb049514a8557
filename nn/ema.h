#pragma once

#include <vector>

#include "nn/tensor_file.h"
#include "nn/torch.h"

namespace simwright::nn {

// The exponential moving average of a module's parameters, which is kept after training.
class Ema {
 public:
  // `decay` in [0, 1) is the share of the average that a step keeps after warm-up; before, it is (1
  // + n) / (10 + n) after n steps, so that the random initial weights are forgotten.
  Ema(const torch::nn::Module& module, double decay);
  void Update(const torch::nn::Module& module);
  // Copies the average into the module's parameters.
  void CopyTo(torch::nn::Module* module) const;

  // Save and restore the state as tensors. Load returns false if they belong to another module.
  void Collect(NamedTensors* tensors) const;
  bool Load(const NamedTensors& tensors);

 private:
  double decay_;
  long updates_ = 0;
  std::vector<torch::Tensor> average_;
};

}  // namespace simwright::nn
