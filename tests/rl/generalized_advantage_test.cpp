// Advantages against the definition of the lambda-return, summed term by term.
#include "rl/generalized_advantage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace simwright::rl {
namespace {

RewardSequence Sequence(int steps, int environments) {
  RewardSequence sequence;
  sequence.steps = steps;
  sequence.environments = environments;
  const auto all = static_cast<std::size_t>(steps * environments);
  sequence.rewards.assign(all, 0.0f);
  sequence.values.assign(all + static_cast<std::size_t>(environments), 0.0f);
  sequence.last_values.assign(all, 0.0f);
  sequence.terminated.assign(all, 0);
  sequence.truncated.assign(all, 0);
  sequence.dropped.assign(all, 0);
  return sequence;
}

RewardSequence RandomSequence(int steps, int environments) {
  RewardSequence sequence = Sequence(steps, environments);
  core::Rng rng(3);
  for (float& value : sequence.rewards) value = static_cast<float>(core::Normal(rng));
  for (float& value : sequence.values) value = static_cast<float>(core::Normal(rng));
  for (float& value : sequence.last_values) value = static_cast<float>(core::Normal(rng));
  for (auto& ended : sequence.terminated) ended = core::Uniform(rng) < 0.1;
  for (auto& ended : sequence.truncated) ended = core::Uniform(rng) < 0.1;
  return sequence;
}

// The lambda-return of step t: (1 - lambda) sum over n of lambda^(n-1) times the n-step return, the
// longest n-step return taking all that is left of the weight.
double LambdaReturn(const RewardSequence& s, int t, int i, double discount, double lambda) {
  double paid = 0.0, power = 1.0, weight = 1.0, sum = 0.0;
  for (int k = t; k < s.steps; ++k) {
    const auto at = static_cast<std::size_t>(k * s.environments + i);
    paid += power * s.rewards[at];
    power *= discount;
    const bool ended = s.terminated[at] || s.truncated[at];
    double next = s.values[at + static_cast<std::size_t>(s.environments)];
    if (s.truncated[at]) next = s.last_values[at];
    if (s.terminated[at]) next = 0.0;
    const double n_step = paid + power * next;
    if (ended || k + 1 == s.steps) return sum + weight * n_step;
    sum += weight * (1.0 - lambda) * n_step;
    weight *= lambda;
  }
  return sum;
}

TEST(GeneralizedAdvantage, IsTheLambdaReturnLessTheValue) {
  const RewardSequence sequence = RandomSequence(60, 5);
  for (const double lambda : {0.0, 0.5, 0.95, 1.0}) {
    const Advantages result = GeneralizedAdvantages(sequence, 0.97, lambda);
    for (int t = 0; t < sequence.steps; ++t) {
      for (int i = 0; i < sequence.environments; ++i) {
        const auto at = static_cast<std::size_t>(t * sequence.environments + i);
        const double expected = LambdaReturn(sequence, t, i, 0.97, lambda);
        ASSERT_NEAR(result.returns[at], expected, 2e-5) << t << " " << i << " " << lambda;
        ASSERT_NEAR(result.advantages[at], expected - sequence.values[at], 2e-5);
      }
    }
  }
}

// A reward of 1 forever is worth 1 / (1 - discount). If the critic knows it, a time limit changes
// nothing; treated as the end of the task, it would cost up to the whole value.
TEST(GeneralizedAdvantage, ATimeOutCostsNothingAndAnEndOfTheTaskDoes) {
  constexpr double kDiscount = 0.99, kForEver = 1.0 / (1.0 - kDiscount);
  RewardSequence sequence = Sequence(100, 1);
  for (float& reward : sequence.rewards) reward = 1.0f;
  for (float& value : sequence.values) value = static_cast<float>(kForEver);
  for (float& value : sequence.last_values) value = static_cast<float>(kForEver);
  for (std::size_t t = 9; t < 100; t += 10) sequence.truncated[t] = 1;
  const Advantages right = GeneralizedAdvantages(sequence, kDiscount, 0.95);
  for (std::size_t t = 0; t < 100; ++t) {
    ASSERT_NEAR(right.advantages[t], 0.0, 1e-3);
    ASSERT_NEAR(right.returns[t], kForEver, 1e-3);
  }
  std::swap(sequence.truncated, sequence.terminated);
  const Advantages wrong = GeneralizedAdvantages(sequence, kDiscount, 0.95);
  EXPECT_NEAR(wrong.advantages[9], 1.0 - kForEver, 1e-3);
  EXPECT_NEAR(wrong.advantages[8], 0.99 * 0.95 * (1.0 - kForEver), 1e-3);
}

// The next episode's first value must not leak into the previous episode.
TEST(GeneralizedAdvantage, ATruncatedStepLooksAtItsOwnLastObservation) {
  RewardSequence sequence = Sequence(2, 1);
  sequence.truncated[0] = 1;
  sequence.last_values[0] = 3.0f;
  sequence.values = {0.0f, 100.0f, 0.0f};
  const Advantages result = GeneralizedAdvantages(sequence, 0.5, 1.0);
  EXPECT_FLOAT_EQ(result.advantages[0], 1.5f);
}

TEST(GeneralizedAdvantage, ADroppedStepIsCutOut) {
  RewardSequence sequence = Sequence(3, 1);
  sequence.rewards = {1.0f, std::nanf(""), 1.0f};
  sequence.values = {0.0f, 4.0f, 0.0f, 2.0f};
  sequence.dropped[1] = 1;
  const Advantages result = GeneralizedAdvantages(sequence, 0.5, 0.9);
  EXPECT_FLOAT_EQ(result.advantages[0], 3.0f);  // 1 + 0.5 * 4
  EXPECT_FLOAT_EQ(result.advantages[1], 0.0f);
  EXPECT_FLOAT_EQ(result.advantages[2], 2.0f);
}

}  // namespace
}  // namespace simwright::rl
