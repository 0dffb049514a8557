#pragma once

#include <optional>

#include "nn/device_table.h"
#include "nn/torch.h"

namespace simwright::scene {

// Diffusion of classes by mask and replace (Austin et al. 2021, D3PM; Gu et al. 2022, whose end
// values Pfaff et al. keep): over K classes and a mask, the class K,
//   q(x_t = j | x_0 = k) = a_t [j = k] + b_t for j < K,  q(x_t = mask) = c_t,
// with a_t linear from 0.99999 to 9e-6 and c_t linear from 9e-6 to 0.99999; b_t = (1 - a_t - c_t) /
// K is close to zero, so that a class is kept until it is masked. t = 0 .. steps - 1; the step
// before the first is the clean class, a = 1.
class CategoryDiffusion {
 public:
  CategoryDiffusion(int steps, int classes);

  int steps() const { return steps_; }
  int classes() const { return classes_; }
  int mask() const { return classes_; }

  // Return a_t, b_t and c_t, t = -1 .. steps - 1.
  double Kept(int t) const { return kept_.At(t + 1); }
  double Replaced(int t) const { return replaced_.At(t + 1); }
  double Masked(int t) const { return masked_.At(t + 1); }

  // Samples x_t (B x N, int64) given x_0 (B x N) and t (B).
  torch::Tensor AddNoise(const torch::Tensor& clean, const torch::Tensor& t,
                         const at::Generator& generator) const;

  // Returns p(x_s | x_t) = sum_k p(x_0 = k) q(x_s | x_t, x_0 = k), (B x N x K + 1), for the
  // predicted probabilities of x_0, `clean` (B x N x K); -1 <= s < t. t and s: (B).
  torch::Tensor Posterior(const torch::Tensor& noisy, const torch::Tensor& clean,
                          const torch::Tensor& t, const torch::Tensor& s) const;

  // Returns KL(q(x_{t-1} | x_t, x_0) || p(x_{t-1} | x_t)), (B x N); for t = 0 it is -log p(x_0 |
  // x_t).
  torch::Tensor Divergence(const torch::Tensor& clean, const torch::Tensor& noisy,
                           const torch::Tensor& log_clean, const torch::Tensor& t) const;

  // Samples the class of each token from its probabilities (B x N x any), with the Gumbel-max
  // trick.
  static torch::Tensor Draw(const torch::Tensor& probabilities, const at::Generator& generator);

 private:
  // Returns `table` at t (B), as (B x 1 x 1), double.
  torch::Tensor At(const nn::DeviceTable& table, const torch::Tensor& t) const;

  int steps_, classes_;
  nn::DeviceTable kept_, masked_, replaced_;  // (steps + 1)
};

}  // namespace simwright::scene
