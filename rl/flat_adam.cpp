#include "rl/flat_adam.h"

#include <cmath>

namespace simwright::rl {
namespace {

constexpr double kBeta1 = 0.9, kBeta2 = 0.999;  // the paper's

}  // namespace

FlatAdam::FlatAdam(std::int64_t count, double epsilon, torch::Device device)
    : epsilon_(epsilon),
      means_(torch::zeros({count}, device)),
      squares_(torch::zeros({count}, device)),
      scale_(torch::zeros({count}, device)) {}

void FlatAdam::Step(const torch::Tensor& gradients, double rate, const torch::Tensor& parameters) {
  const torch::NoGradGuard no_grad;
  ++steps_;
  const double bias1 = 1.0 - std::pow(kBeta1, static_cast<double>(steps_));
  const double bias2 = 1.0 - std::pow(kBeta2, static_cast<double>(steps_));
  means_.lerp_(gradients, 1.0 - kBeta1);
  squares_.mul_(kBeta2).addcmul_(gradients, gradients, 1.0 - kBeta2);
  torch::sqrt_out(scale_, squares_).div_(std::sqrt(bias2)).add_(epsilon_);
  // A tensor copy shares its storage; the parameters are passed as const.
  torch::Tensor(parameters).addcdiv_(means_, scale_, -rate / bias1);
}

void FlatAdam::Restore(const torch::Tensor& means, const torch::Tensor& squares,
                       std::int64_t steps) {
  means_.copy_(means);
  squares_.copy_(squares);
  steps_ = steps;
}

}  // namespace simwright::rl
