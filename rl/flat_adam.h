#pragma once

#include <cstdint>

#include "nn/torch.h"

namespace simwright::rl {

// Adam (Kingma and Ba 2015) on a flat vector of parameters.
class FlatAdam {
 public:
  // `count`: number of parameters. `epsilon` bounds the steps of parameters with small gradients.
  FlatAdam(std::int64_t count, double epsilon, torch::Device device);

  // Takes one step of learning rate `rate` against `gradients`, in place. All (count).
  void Step(const torch::Tensor& gradients, double rate, const torch::Tensor& parameters);

  const torch::Tensor& means() const { return means_; }      // (count) of the gradients
  const torch::Tensor& squares() const { return squares_; }  // (count) of their squares
  std::int64_t steps() const { return steps_; }
  void Restore(const torch::Tensor& means, const torch::Tensor& squares, std::int64_t steps);

 private:
  double epsilon_;
  torch::Tensor means_, squares_, scale_;
  std::int64_t steps_ = 0;
};

}  // namespace simwright::rl
