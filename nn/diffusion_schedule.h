#pragma once

#include "nn/device_table.h"
#include "nn/torch.h"

namespace simwright::nn {

// A discrete variance-preserving diffusion (Ho et al. 2020): x_t = a_t x_0 + s_t noise with a_t^2 +
// s_t^2 = 1, t = 0 .. steps - 1.
class DiffusionSchedule {
 public:
  // Returns the cosine schedule (Nichol and Dhariwal 2021, offset 0.008), betas at most 0.999.
  static DiffusionSchedule Cosine(int steps);
  // Returns a schedule whose betas' square roots rise linearly from `first` to `last`, as in latent
  // diffusion (Rombach et al. 2022) and Zero-1-to-3: 0.00085 to 0.012 over 1000 steps.
  static DiffusionSchedule ScaledLinear(int steps, double first, double last);

  // Returns a schedule whose betas rise linearly from `first` to `last` (Ho et al. 2020: 1e-4 to
  // 0.02 over 1000 steps).
  static DiffusionSchedule Linear(int steps, double first, double last);

  int steps() const { return static_cast<int>(signal_.size()); }
  // Return a_t and s_t for t (B, int64), on t's device, with `rank` dimensions: (B x 1 x 1 x 1) for
  // images.
  torch::Tensor Signal(const torch::Tensor& t, std::int64_t rank = 4) const;
  torch::Tensor Noise(const torch::Tensor& t, std::int64_t rank = 4) const;
  double SignalAt(int t) const { return signal_.At(t); }
  double NoiseAt(int t) const { return noise_.At(t); }

  // Returns x_t from x_0 and noise, (B x C x H x W) each or of another rank.
  torch::Tensor AddNoise(const torch::Tensor& clean, const torch::Tensor& noise,
                         const torch::Tensor& t) const;
  // Returns the x_0 implied by x_t and its predicted noise.
  torch::Tensor CleanFrom(const torch::Tensor& noisy, const torch::Tensor& noise,
                          const torch::Tensor& t) const;
  // Takes the deterministic DDIM step (Song et al. 2021) from t to `previous` < t; -1: to x_0.
  torch::Tensor DdimStep(const torch::Tensor& noisy, const torch::Tensor& noise, int t,
                         int previous) const;
  // Returns the standard deviation of StochasticStep, and its mean: the step without noise.
  double StepDeviation(int t, int previous, double eta) const;
  torch::Tensor StepMean(const torch::Tensor& noisy, const torch::Tensor& clean, int t,
                         int previous, double eta) const;
  // Takes the DDIM step from a predicted x_0 with a share `eta` in [0, 1] of the noise of the
  // posterior q(x_previous | x_t, x_0) (Song et al. 2021, equation 16). 1 samples from that
  // posterior, which with previous = t - 1 is the step of Ho et al. `fresh` is standard normal.
  torch::Tensor StochasticStep(const torch::Tensor& noisy, const torch::Tensor& clean, int t,
                               int previous, double eta, const torch::Tensor& fresh) const;

 private:
  // `kept` (steps): the products of 1 - beta.
  explicit DiffusionSchedule(const torch::Tensor& kept);
  static DiffusionSchedule OfBetas(const torch::Tensor& betas);

  DeviceTable signal_, noise_;  // (steps)
};

}  // namespace simwright::nn
