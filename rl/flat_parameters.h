#pragma once

#include <cstdint>
#include <vector>

#include "nn/torch.h"

namespace simwright::rl {

// A network's parameters as views into one flat tensor, and their gradients as views into another:
// an optimizer step, the gradient norm, a file and an all-reduce are each one operation on that
// tensor instead of one per parameter.
class FlatParameters {
 public:
  // Allocates zeros on `device`.
  FlatParameters(const std::vector<std::vector<std::int64_t>>& shapes, torch::Device device);

  // Returns parameter `i`, a leaf of autograd; its gradient is accumulated into gradients().
  const torch::Tensor& operator[](std::size_t i) const { return parameters_[i]; }
  std::size_t size() const { return parameters_.size(); }

  const torch::Tensor& values() const { return values_; }        // (P)
  const torch::Tensor& gradients() const { return gradients_; }  // (P)

 private:
  torch::Tensor values_, gradients_;
  std::vector<torch::Tensor> parameters_;
};

}  // namespace simwright::rl
