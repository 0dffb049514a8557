#include "rl/flat_parameters.h"

namespace simwright::rl {

FlatParameters::FlatParameters(const std::vector<std::vector<std::int64_t>>& shapes,
                               torch::Device device) {
  std::int64_t count = 0;
  for (const auto& shape : shapes) count += c10::multiply_integers(shape);
  values_ = torch::zeros({count}, device);
  gradients_ = torch::zeros({count}, device);
  std::int64_t first = 0;
  for (const auto& shape : shapes) {
    const std::int64_t size = c10::multiply_integers(shape);
    torch::Tensor leaf = values_.narrow(0, first, size).view(shape).detach();
    leaf.requires_grad_(true);
    // Autograd accumulates into an existing gradient.
    leaf.mutable_grad() = gradients_.narrow(0, first, size).view(shape);
    parameters_.push_back(leaf);
    first += size;
  }
}

}  // namespace simwright::rl
