#include "nn/diffusion_schedule.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"

namespace simwright::nn {
namespace {

TEST(DiffusionSchedule, KeepsTheVarianceAndItsEnds) {
  for (const DiffusionSchedule& schedule :
       {DiffusionSchedule::Cosine(1000), DiffusionSchedule::ScaledLinear(1000, 0.00085, 0.012)}) {
    for (int t = 0; t < 999; t += 37) {
      EXPECT_NEAR(std::pow(schedule.SignalAt(t), 2) + std::pow(schedule.NoiseAt(t), 2), 1.0, 1e-12);
      EXPECT_LT(schedule.SignalAt(t + 1), schedule.SignalAt(t));
    }
  }
  // Nichol and Dhariwal's a_t^2 = f(t) / f(0), f(t) = cos^2((t / T + s) / (1 + s) pi / 2).
  const auto f = [](double t) { return std::pow(std::cos((t + 0.008) / 1.008 * M_PI / 2), 2); };
  const DiffusionSchedule cosine = DiffusionSchedule::Cosine(1000);
  EXPECT_NEAR(std::pow(cosine.SignalAt(499), 2), f(0.5) / f(0.0), 1e-6);
  // Stable diffusion's sqrt(alphas_cumprod) at its last step is 0.0683.
  EXPECT_NEAR(DiffusionSchedule::ScaledLinear(1000, 0.00085, 0.012).SignalAt(999), 0.0683, 2e-4);
}

TEST(DiffusionSchedule, StepsWithTheTrueNoiseLeadToTheCleanPicture) {
  const DiffusionSchedule schedule = DiffusionSchedule::Cosine(100);
  torch::manual_seed(3);
  const torch::Tensor clean = torch::randn({2, 3, 4, 4}), noise = torch::randn({2, 3, 4, 4});
  const torch::Tensor t = torch::full({2}, 90, torch::kLong);
  torch::Tensor x = schedule.AddNoise(clean, noise, t);
  EXPECT_LT((schedule.CleanFrom(x, noise, t) - clean).abs().max().item<double>(), 1e-4);
  for (int at = 90; at >= 0; at -= 10) x = schedule.DdimStep(x, noise, at, at - 10);
  EXPECT_LT((x - clean).abs().max().item<double>(), 1e-4);
}

TEST(DiffusionSchedule, AStochasticStepDrawsFromThePosterior) {
  // The posterior of two Gaussians in closed form: x_s given x_0, and x_t given x_s.
  const DiffusionSchedule schedule = DiffusionSchedule::Linear(1000, 1e-4, 0.02);
  // sqrt of the product of 1 - beta over all 1000 steps, by hand: exp(0.5 sum log(1 - beta)).
  double log_kept = 0.0;
  for (int i = 0; i < 1000; ++i) log_kept += std::log(1.0 - (1e-4 + i * (0.02 - 1e-4) / 999.0));
  EXPECT_NEAR(schedule.SignalAt(999), std::exp(0.5 * log_kept), 1e-12);
  const torch::Tensor clean = torch::full({1}, 0.7, torch::kDouble);
  const torch::Tensor noisy = torch::full({1}, -0.4, torch::kDouble);
  const torch::Tensor none = torch::zeros({1}, torch::kDouble), one = torch::ones_like(none);
  for (const auto& [t, s] : {std::pair(500, 499), std::pair(800, 300), std::pair(1, 0)}) {
    const double a = schedule.SignalAt(t) / schedule.SignalAt(s);
    const double step_variance = 1.0 - a * a, variance = std::pow(schedule.NoiseAt(s), 2);
    const double precision = 1.0 / variance + a * a / step_variance;
    const double mean =
        (schedule.SignalAt(s) * 0.7 / variance + a * -0.4 / step_variance) / precision;
    EXPECT_NEAR(schedule.StochasticStep(noisy, clean, t, s, 1.0, none).item<double>(), mean, 1e-9);
    const double deviation = schedule.StochasticStep(noisy, clean, t, s, 1.0, one).item<double>() -
                             schedule.StochasticStep(noisy, clean, t, s, 1.0, none).item<double>();
    EXPECT_NEAR(deviation, std::sqrt(1.0 / precision), 1e-9);
    // Without noise it is the deterministic step.
    const torch::Tensor noise = (noisy - schedule.SignalAt(t) * clean) / schedule.NoiseAt(t);
    EXPECT_NEAR(schedule.StochasticStep(noisy, clean, t, s, 0.0, one).item<double>(),
                schedule.DdimStep(noisy, noise, t, s).item<double>(), 1e-9);
  }
}

TEST(DiffusionSchedule, RefusesWhatIsNone) {
  EXPECT_THROW(DiffusionSchedule::Cosine(1), core::Error);
  EXPECT_THROW(DiffusionSchedule::ScaledLinear(10, 0.1, 0.01), core::Error);
}

}  // namespace
}  // namespace simwright::nn
