// Limits of the numbers of objects in sampled scenes: the tilted probabilities are the closest ones
// with the wanted expectation, samples of independent classes follow the conditional distribution,
// and a model holds the counts of a prompt.
#include "scene/model/limited_classes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/error.h"
#include "scene/model/category_diffusion.h"

namespace simwright::scene {
namespace {

at::Generator LimitGenerator(std::uint64_t seed) {
  return at::detail::createCPUGenerator(seed);
}

TEST(LimitedClasses, TiltsToTheClosestProbabilities) {
  // Two masked entries, three classes; exactly one object of class 0 is wanted. The projection
  // multiplies class 0 by w in each entry: 0.6 w / (0.6 w + 0.4) + 0.1 w / (0.1 w + 0.9) = 1,
  // 0.06 w^2 = 0.36, w = sqrt(6).
  const LimitedClasses limits({{{{0}, 1, 1}, {{1}, 0, 9}}}, 3);
  const torch::Tensor p = torch::tensor({{{0.6f, 0.3f, 0.1f}, {0.1f, 0.4f, 0.5f}}});
  const torch::Tensor tilted = limits.Tilt(p, torch::full({1, 2}, 3, torch::kLong));
  const double w = std::sqrt(6.0);
  EXPECT_NEAR(tilted[0][0][0].item<double>(), 0.6 * w / (0.6 * w + 0.4), 1e-3);
  EXPECT_NEAR(tilted[0][0][1].item<double>(), 0.3 / (0.6 * w + 0.4), 1e-3);
  EXPECT_NEAR(tilted[0][1][0].item<double>(), 0.1 * w / (0.1 * w + 0.9), 1e-3);
  EXPECT_NEAR(tilted[0][1][2].item<double>(), 0.5 / (0.1 * w + 0.9), 1e-3);
}

TEST(LimitedClasses, LeavesProbabilitiesWithinTheLimits) {
  const LimitedClasses limits({{{{0}, 0, 1}, {{1, 2}, 1, 3}}, {}}, 4);
  const torch::Tensor p = torch::softmax(torch::randn({2, 3, 4}, LimitGenerator(3)), -1);
  const torch::Tensor even = torch::full({2, 3, 4}, 0.25f);
  const torch::Tensor masked = torch::full({2, 3}, 4, torch::kLong);
  EXPECT_TRUE(limits.Tilt(even, masked).allclose(even, 0.0, 1e-6));
  EXPECT_TRUE(limits.Tilt(p, masked)[1].equal(p[1])) << "a scene without limits";
}

TEST(LimitedClasses, KeepsTheExpectedNumberOfOtherClasses) {
  // Class 1 is furniture, class 3 is empty. Class 0 is wanted four times as often as predicted.
  const LimitedClasses limits({{{{0}, 8, 8}, {{2}, 0, 0}}}, 4);
  const torch::Tensor p = torch::softmax(
      torch::randn({1, 20, 4}, LimitGenerator(4)) + torch::tensor({-1.0f, -2.0f, 0.0f, 1.0f}), -1);
  const torch::Tensor tilted = limits.Tilt(p, torch::full({1, 20}, 4, torch::kLong));
  const torch::Tensor expected = tilted.sum(1)[0];
  EXPECT_NEAR(expected[0].item<double>(), 8.0, 0.01);
  EXPECT_NEAR(expected[1].item<double>(), p.sum(1)[0][1].item<double>(), 0.01);
  EXPECT_EQ(expected[2].item<double>(), 0.0);
  EXPECT_TRUE(tilted.sum(-1).allclose(torch::ones({1, 20}), 0.0, 1e-4));
}

TEST(LimitedClasses, CountsTheEntriesThatAreDecided) {
  // One of class 0 is there already, so that none may follow; two of class 1 must.
  const LimitedClasses limits({{{{0}, 1, 1}, {{1}, 2, 2}}}, 3);
  torch::Tensor noisy = torch::full({1, 4}, 3, torch::kLong);
  noisy[0][2] = 0;
  const torch::Tensor tilted = limits.Tilt(torch::full({1, 4, 3}, 1.0f / 3.0f), noisy);
  for (const int i : {0, 1, 3}) {
    EXPECT_EQ(tilted[0][i][0].item<float>(), 0.0f);
    EXPECT_NEAR(tilted[0][i][1].item<double>(), 2.0 / 3.0, 1e-3);
  }
  EXPECT_NEAR(tilted[0][2][0].item<double>(), 1.0 / 3.0, 1e-6) << "a decided entry";
}

// Samples scenes from independent classes in `steps` steps.
torch::Tensor SampleIndependent(const torch::Tensor& p, int scenes, int entries, int steps,
                                const std::vector<ClassLimit>& limit) {
  const int classes = static_cast<int>(p.size(0));
  const LimitedClasses limits(
      std::vector<std::vector<ClassLimit>>(static_cast<size_t>(scenes), limit), classes);
  const CategoryDiffusion diffusion(1000, classes);
  const at::Generator generator = LimitGenerator(7);
  torch::Tensor x = torch::full({scenes, entries}, diffusion.mask(), torch::kLong);
  for (int i = steps; i > 0; --i) {
    const torch::Tensor t = torch::full({scenes}, 1000 * i / steps - 1, torch::kLong);
    const torch::Tensor s = torch::full({scenes}, 1000 * (i - 1) / steps - 1, torch::kLong);
    const torch::Tensor clean = limits.Tilt(p.expand({scenes, entries, classes}), x);
    torch::Tensor drawn = CategoryDiffusion::Draw(diffusion.Posterior(x, clean, t, s), generator);
    limits.Hold(x, clean, i == 1, generator, &drawn);
    x = drawn;
  }
  return x;
}

TEST(LimitedClasses, SamplesTheConditionalDistribution) {
  // Five entries, p = (0.5, 0.3, 0.2), exactly two of class 0: the other three are of class 1 with
  // probability 0.6 each.
  const torch::Tensor p = torch::tensor({0.5f, 0.3f, 0.2f});
  constexpr int kScenes = 4000;
  const torch::Tensor x = SampleIndependent(p, kScenes, 5, 40, {{{0}, 2, 2}, {{1}, 0, 5}});
  EXPECT_TRUE((x == 0).sum(1).eq(2).all().item<bool>());
  const torch::Tensor ones = (x == 1).sum(1);
  const double expected[] = {0.064, 0.288, 0.432, 0.216};  // binomial, 3 and 0.6
  for (int k = 0; k < 4; ++k) {
    const double share = (ones == k).to(torch::kFloat).mean().item<double>();
    EXPECT_NEAR(share, expected[k], 4.0 * std::sqrt(expected[k] / kScenes)) << k;
  }
  // Each entry is of class 0 as often as the others.
  const torch::Tensor by_entry = (x == 0).to(torch::kFloat).mean(0);
  EXPECT_TRUE(by_entry.allclose(torch::full({5}, 0.4f), 0.0, 0.05)) << by_entry;
}

TEST(LimitedClasses, HoldsInFewSteps) {
  const torch::Tensor p = torch::tensor({0.05f, 0.05f, 0.3f, 0.6f});
  for (const int steps : {1, 2, 5}) {
    const torch::Tensor x =
        SampleIndependent(p, 200, 12, steps, {{{0}, 4, 4}, {{1}, 3, 3}, {{2}, 0, 2}});
    EXPECT_TRUE((x == 0).sum(1).eq(4).all().item<bool>()) << steps;
    EXPECT_TRUE((x == 1).sum(1).eq(3).all().item<bool>()) << steps;
    EXPECT_TRUE((x == 2).sum(1).le(2).all().item<bool>()) << steps;
  }
}

TEST(LimitedClasses, MeetsLimitsAsFarAsTheyGo) {
  // More objects than entries, and a class that the network gives no probability.
  const torch::Tensor p = torch::tensor({0.5f, 0.0f, 0.5f});
  const torch::Tensor x = SampleIndependent(p, 20, 3, 10, {{{0}, 5, 5}});
  EXPECT_TRUE(x.eq(0).all().item<bool>());
  const torch::Tensor y = SampleIndependent(p, 20, 3, 10, {{{1}, 2, 2}});
  EXPECT_TRUE(y.lt(3).all().item<bool>()) << "nothing stays masked";
}

TEST(LimitedClasses, RefusesLimitsThatAreNone) {
  EXPECT_THROW(LimitedClasses({{{{3}, 0, 1}}}, 4), core::Error) << "the empty class";
  EXPECT_THROW(LimitedClasses({{{{-1}, 0, 1}}}, 4), core::Error);
  EXPECT_THROW(LimitedClasses({{{{0}, 2, 1}}}, 4), core::Error);
  EXPECT_THROW(LimitedClasses({{{{0}, -1, 1}}}, 4), core::Error);
  EXPECT_THROW(LimitedClasses({{{{0, 1}, 0, 1}, {{1}, 0, 1}}}, 4), core::Error);
}

}  // namespace
}  // namespace simwright::scene
