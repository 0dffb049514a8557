#pragma once

#include <cstdint>
#include <vector>

#include "nn/torch.h"

namespace simwright::rl {

// A network's parameters as views into one row of numbers, and their gradients as views into
// another: an optimiser's step, the gradient's norm, a file and a sum over machines are each one
// operation on that row instead of one a parameter.
class FlatParameters {
 public:
  // All zero, on `device`.
  FlatParameters(const std::vector<std::vector<std::int64_t>>& shapes, torch::Device device);

  // A leaf of autograd; its gradient is added into gradients().
  const torch::Tensor& operator[](std::size_t i) const { return parameters_[i]; }
  std::size_t size() const { return parameters_.size(); }

  const torch::Tensor& values() const { return values_; }        // (P)
  const torch::Tensor& gradients() const { return gradients_; }  // (P)

 private:
  torch::Tensor values_, gradients_;
  std::vector<torch::Tensor> parameters_;
};

}  // namespace simwright::rl
