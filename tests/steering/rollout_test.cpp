// The densities of denoising steps against closed forms and finite differences, and advantages.
#include "steering/post_training/rollout.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "steering/post_training/advantages.h"
#include "tests/steering/post_training_scenes.h"

namespace simwright::steering {
namespace {

constexpr int kClasses = 4, kScenes = 3, kEntries = 5, kSteps = 10;

std::shared_ptr<scene::Denoiser> SmallDenoiser(bool continuous) {
  torch::manual_seed(5);
  std::shared_ptr<scene::Denoiser> denoiser = scene::MakeDenoiser(SmallModel(continuous), kClasses);
  const torch::NoGradGuard no_gradient;
  for (torch::Tensor& one : denoiser->parameters()) one.add_(0.05 * torch::randn_like(one));
  return denoiser;
}

Rollout SmallRollout(const scene::SceneDiffusion& diffusion, scene::Denoiser* denoiser) {
  return RollOut(diffusion, denoiser, kScenes, kEntries, kSteps, {}, torch::kCPU,
                 at::detail::createCPUGenerator(3));
}

TEST(Rollout, LogProbabilitiesAreThoseOfTheirDistributions) {
  for (const bool continuous : {false, true}) {
    const scene::SceneDiffusion diffusion(SmallModel(continuous), kClasses);
    scene::NoisyScenes scenes = diffusion.Noise(1, 2, at::detail::createCPUGenerator(1));
    scene::StepDistribution distribution;
    distribution.pose_mean = 0.3 * torch::randn({1, 2, 12});
    distribution.deviation = 0.4;
    double expected = 0.0;
    const auto add_normals = [&](const torch::Tensor& x, const torch::Tensor& mean) {
      for (std::int64_t i = 0; i < x.numel(); ++i) {
        const double z = (x.flatten()[i].item<double>() - mean.flatten()[i].item<double>()) / 0.4;
        expected += std::log(std::exp(-0.5 * z * z) / (0.4 * std::sqrt(2.0 * M_PI)));
      }
    };
    add_normals(scenes.poses, distribution.pose_mean);
    if (continuous) {
      distribution.class_mean = 0.2 * torch::randn({1, 2, kClasses});
      add_normals(scenes.classes, distribution.class_mean);
    } else {
      distribution.class_probabilities = torch::softmax(torch::randn({1, 2, kClasses + 1}), -1);
      scenes.classes = torch::tensor({{1, 4}}, torch::kLong);
      expected += std::log(distribution.class_probabilities[0][0][1].item<double>());
      expected += std::log(distribution.class_probabilities[0][1][4].item<double>());
    }
    EXPECT_NEAR(diffusion.LogProbability(distribution, scenes).item<double>(), expected, 1e-3);
    // A part that is certain has no density.
    distribution.deviation = 0.0;
    const double classes =
        continuous ? 0.0
                   : std::log(distribution.class_probabilities[0][0][1].item<double>()) +
                         std::log(distribution.class_probabilities[0][1][4].item<double>());
    EXPECT_NEAR(diffusion.LogProbability(distribution, scenes).item<double>(), classes, 1e-5);
  }
}

TEST(Rollout, ReplaysItsOwnSteps) {
  const torch::NoGradGuard no_gradient;
  for (const bool continuous : {false, true}) {
    const scene::SceneDiffusion diffusion(SmallModel(continuous), kClasses);
    const std::shared_ptr<scene::Denoiser> denoiser = SmallDenoiser(continuous);
    const Rollout rollout = SmallRollout(diffusion, denoiser.get());
    ASSERT_EQ(rollout.Steps(), kSteps);
    ASSERT_EQ(rollout.states.size(), kSteps + 1u);
    for (int step = 0; step < kSteps; ++step) {
      for (int i = 0; i < kScenes; ++i) {
        const double again =
            StepLogProbability(diffusion, denoiser.get(), rollout, step, i, 1, {}).item<double>();
        const double before =
            rollout.log_probabilities[static_cast<size_t>(step)][i].item<double>();
        EXPECT_NEAR(again, before, 1e-3 * std::max(1.0, std::abs(before))) << step;
      }
    }
  }
}

TEST(Rollout, GradientsOfStepsAreFiniteDifferences) {
  for (const bool continuous : {false, true}) {
    const scene::SceneDiffusion diffusion(SmallModel(continuous), kClasses);
    const std::shared_ptr<scene::Denoiser> denoiser = SmallDenoiser(continuous);
    const Rollout rollout = SmallRollout(diffusion, denoiser.get());
    const auto value = [&] {
      return StepLogProbability(diffusion, denoiser.get(), rollout, 2, 0, kScenes, {}).sum();
    };
    // Along the gradient itself, over all parameters.
    const std::vector<torch::Tensor> parameters = denoiser->parameters();
    const auto gradients =
        torch::autograd::grad({value()}, parameters, {}, {}, false, /*allow_unused=*/true);
    double norm = 0.0;
    for (const torch::Tensor& one : gradients) {
      if (one.defined()) norm += one.square().sum().item<double>();
    }
    norm = std::sqrt(norm);
    ASSERT_GT(norm, 1e-3);
    const double step = 2e-3;
    const auto moved_by = [&](double along) {
      const torch::NoGradGuard no_gradient;
      for (size_t i = 0; i < parameters.size(); ++i) {
        if (gradients[i].defined()) parameters[i].add_(gradients[i], along / norm);
      }
      return value().item<double>();
    };
    const double up = moved_by(step), down = moved_by(-2.0 * step);
    moved_by(step);
    EXPECT_NEAR((up - down) / (2.0 * step), norm, 0.02 * norm) << continuous;
  }
}

TEST(Advantages, AreStandardisedWithinTheirGroup) {
  const std::vector<double> all = Advantages({1, 2, 3, 4});
  const double deviation = std::sqrt(1.25);
  EXPECT_NEAR(all[0], -1.5 / deviation, 1e-12);
  EXPECT_NEAR(all[3], 1.5 / deviation, 1e-12);
  // Two prompts: 1, 3 and 10, 10.
  const std::vector<double> groups = Advantages({1, 10, 3, 10}, 2);
  EXPECT_NEAR(groups[0], -1.0, 1e-12);
  EXPECT_NEAR(groups[2], 1.0, 1e-12);
  EXPECT_EQ(groups[1], 0.0);
  EXPECT_EQ(groups[3], 0.0);
  std::vector<double> one_high(101, 0.0);
  one_high[7] = 1.0;
  EXPECT_EQ(Advantages(one_high)[7], kLargestAdvantage);
  EXPECT_THROW(Advantages({1.0, std::nan("")}), core::Error);
  EXPECT_THROW(Advantages({1.0}, 0), core::Error);
}

}  // namespace
}  // namespace simwright::steering
