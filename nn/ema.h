#pragma once

#include <vector>

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

  void Save(torch::serialize::OutputArchive* archive) const;
  // Throws c10::Error where the archive holds another module's average.
  void Load(torch::serialize::InputArchive* archive);

 private:
  double decay_;
  long updates_ = 0;
  std::vector<torch::Tensor> average_;
};

}  // namespace simwright::nn
