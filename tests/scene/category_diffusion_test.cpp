// Mask-and-replace diffusion against brute force: chains of transition matrices, summed over all
// paths.
#include "scene/model/category_diffusion.h"

#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Dense>

#include "core/error.h"

namespace simwright::scene {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kCategoryDiffusionClasses = 3, kSteps = 6;

// Transition from t - 1 to t, rows: from; the last state is the mask.
MatrixXd StepMatrix(const CategoryDiffusion& diffusion, int t) {
  const double a = diffusion.Kept(t) / diffusion.Kept(t - 1);
  const double c = 1.0 - (1.0 - diffusion.Masked(t)) / (1.0 - diffusion.Masked(t - 1));
  const double b = (1.0 - a - c) / kCategoryDiffusionClasses;
  MatrixXd matrix =
      MatrixXd::Constant(kCategoryDiffusionClasses + 1, kCategoryDiffusionClasses + 1, b);
  for (int i = 0; i < kCategoryDiffusionClasses; ++i) {
    matrix(i, i) += a;
    matrix(i, kCategoryDiffusionClasses) = c;
  }
  matrix.row(kCategoryDiffusionClasses).setZero();
  matrix(kCategoryDiffusionClasses, kCategoryDiffusionClasses) = 1.0;
  return matrix;
}

// From s to t.
MatrixXd Chain(const CategoryDiffusion& diffusion, int s, int t) {
  MatrixXd chain = MatrixXd::Identity(kCategoryDiffusionClasses + 1, kCategoryDiffusionClasses + 1);
  for (int i = s + 1; i <= t; ++i) chain = chain * StepMatrix(diffusion, i);
  return chain;
}

// sum_k p(k) q(x_s | x_t, x_0 = k), Bayes' rule over the chain.
VectorXd BruteForce(const CategoryDiffusion& diffusion, int noisy, const VectorXd& belief, int t,
                    int s) {
  const MatrixXd to_s = Chain(diffusion, -1, s), on = Chain(diffusion, s, t);
  VectorXd posterior = VectorXd::Zero(kCategoryDiffusionClasses + 1);
  for (int k = 0; k < kCategoryDiffusionClasses; ++k) {
    double evidence = 0.0;
    for (int i = 0; i <= kCategoryDiffusionClasses; ++i) evidence += to_s(k, i) * on(i, noisy);
    for (int i = 0; i <= kCategoryDiffusionClasses; ++i) {
      posterior[i] += belief[k] * to_s(k, i) * on(i, noisy) / evidence;
    }
  }
  return posterior;
}

TEST(CategoryDiffusion, TheChainsOfItsStepsAreItsMarginals) {
  const CategoryDiffusion diffusion(kSteps, kCategoryDiffusionClasses);
  EXPECT_NEAR(diffusion.Kept(0), 0.99999, 1e-12);
  EXPECT_NEAR(diffusion.Kept(kSteps - 1), 9e-6, 1e-12);
  EXPECT_NEAR(diffusion.Masked(0), 9e-6, 1e-12);
  EXPECT_NEAR(diffusion.Masked(kSteps - 1), 0.99999, 1e-12);
  for (int t = 0; t < kSteps; ++t) {
    const MatrixXd chain = Chain(diffusion, -1, t);
    EXPECT_NEAR(chain(0, 0), diffusion.Kept(t) + diffusion.Replaced(t), 1e-12);
    EXPECT_NEAR(chain(0, 1), diffusion.Replaced(t), 1e-12);
    EXPECT_NEAR(chain(0, kCategoryDiffusionClasses), diffusion.Masked(t), 1e-12);
  }
}

TEST(CategoryDiffusion, PosteriorsAreThoseOfBruteForce) {
  const CategoryDiffusion diffusion(kSteps, kCategoryDiffusionClasses);
  const std::vector<std::vector<float>> beliefs = {
      {0.2f, 0.5f, 0.3f}, {1, 0, 0}, {0, 0.01f, 0.99f}};
  for (const std::vector<float>& belief : beliefs) {
    const VectorXd p =
        Eigen::Map<const Eigen::VectorXf>(belief.data(), kCategoryDiffusionClasses).cast<double>();
    for (int t = 0; t < kSteps; ++t) {
      for (int s = -1; s < t; ++s) {
        for (int noisy = 0; noisy <= kCategoryDiffusionClasses; ++noisy) {
          const torch::Tensor posterior = diffusion.Posterior(
              torch::full({1, 1}, noisy, torch::kLong),
              torch::tensor(belief).reshape({1, 1, kCategoryDiffusionClasses}),
              torch::full({1}, t, torch::kLong), torch::full({1}, s, torch::kLong));
          const VectorXd truth = BruteForce(diffusion, noisy, p, t, s);
          for (int i = 0; i <= kCategoryDiffusionClasses; ++i) {
            EXPECT_NEAR(posterior[0][0][i].item<double>(), truth[i], 2e-5)
                << "t " << t << " s " << s << " x_t " << noisy << " x_s " << i;
          }
        }
      }
    }
  }
}

TEST(CategoryDiffusion, DivergenceIsItsDefinition) {
  const CategoryDiffusion diffusion(kSteps, kCategoryDiffusionClasses);
  const std::vector<float> belief = {0.2f, 0.5f, 0.3f};
  const VectorXd p =
      Eigen::Map<const Eigen::VectorXf>(belief.data(), kCategoryDiffusionClasses).cast<double>();
  for (int t = 0; t < kSteps; ++t) {
    for (const int noisy : {1, kCategoryDiffusionClasses}) {
      const double kl =
          diffusion
              .Divergence(torch::full({1, 1}, 1, torch::kLong),
                          torch::full({1, 1}, noisy, torch::kLong),
                          torch::tensor(belief).log().reshape({1, 1, kCategoryDiffusionClasses}),
                          torch::full({1}, t, torch::kLong))
              .item<double>();
      const VectorXd truth =
          BruteForce(diffusion, noisy, VectorXd::Unit(kCategoryDiffusionClasses, 1), t, t - 1);
      const VectorXd guess = BruteForce(diffusion, noisy, p, t, t - 1);
      double expected = 0.0;
      for (int i = 0; i <= kCategoryDiffusionClasses; ++i) {
        if (truth[i] > 0.0) expected += truth[i] * std::log(truth[i] / guess[i]);
      }
      EXPECT_NEAR(kl, expected, 1e-4 * std::max(1.0, expected)) << "t " << t;
      // At the first step it is the negative log-likelihood of the clean class.
      if (t == 0 && noisy == kCategoryDiffusionClasses) {
        EXPECT_NEAR(kl, -std::log(0.5), 1e-4);
      }
    }
  }
}

TEST(CategoryDiffusion, NoiseHasItsShares) {
  const CategoryDiffusion diffusion(1000, kCategoryDiffusionClasses);
  const at::Generator generator = at::detail::createCPUGenerator(7);
  const torch::Tensor clean = torch::full({1, 40000}, 2, torch::kLong);
  for (const int t : {0, 300, 700, 999}) {
    const torch::Tensor noisy =
        diffusion.AddNoise(clean, torch::full({1}, t, torch::kLong), generator);
    const double masked =
        noisy.eq(kCategoryDiffusionClasses).to(torch::kDouble).mean().item<double>();
    const double kept = noisy.eq(2).to(torch::kDouble).mean().item<double>();
    EXPECT_NEAR(masked, diffusion.Masked(t), 0.01) << t;
    EXPECT_NEAR(kept, diffusion.Kept(t), 0.01) << t;
  }
}

TEST(CategoryDiffusion, DrawsByTheirProbabilities) {
  const at::Generator generator = at::detail::createCPUGenerator(3);
  const torch::Tensor shares = torch::tensor({0.1f, 0.0f, 0.6f, 0.3f});
  const torch::Tensor samples =
      CategoryDiffusion::Draw(shares.expand({1, 50000, 4}), generator).squeeze(0);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(samples.eq(i).to(torch::kDouble).mean().item<double>(), shares[i].item<double>(),
                0.01);
  }
  EXPECT_EQ(samples.eq(1).sum().item<int>(), 0);
}

TEST(CategoryDiffusion, RefusesWhatIsNone) {
  EXPECT_THROW(CategoryDiffusion(1, 3), core::Error);
  EXPECT_THROW(CategoryDiffusion(10, 0), core::Error);
}

}  // namespace
}  // namespace simwright::scene
