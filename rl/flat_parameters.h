#pragma once

#include <cstdint>
#include <vector>

#include "nn/torch.h"

namespace simwright::rl {

// A network's parameters as views into one flat tensor, and their gradients as views into another.
// An optimizer step, the gradient norm, writing a file and an all-reduce are therefore each one
// operation on a flat tensor instead of one operation per parameter.
class FlatParameters {
 public:
  // Allocates parameters of the given `shapes` and their gradients on `device`, filled with zeros.
  FlatParameters(const std::vector<std::vector<std::int64_t>>& shapes, torch::Device device);

  // Returns parameter `i` in its own shape. It is an autograd leaf: backward() accumulates its
  // gradient into gradients().
  const torch::Tensor& operator[](std::size_t i) const { return parameters_[i]; }
  std::size_t size() const { return parameters_.size(); }

  // Return the flat tensors; P is the total number of elements of all parameters.
  const torch::Tensor& values() const { return values_; }        // (P)
  const torch::Tensor& gradients() const { return gradients_; }  // (P)

 private:
  torch::Tensor values_, gradients_;
  std::vector<torch::Tensor> parameters_;
};

}  // namespace simwright::rl
