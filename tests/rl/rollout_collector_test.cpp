// The data flow from the environment to the learner, in an environment that counts.
#include "rl/rollout_collector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "rl/ppo_learner.h"

namespace simwright::rl {
namespace {

// Observes the step within its episode, modulo `modulus`; the episode ends by time after `length`.
// Pays 1 per step, forever.
class Counter : public VectorEnvironment {
 public:
  Counter(int count, int length, int modulus)
      : length_(length), modulus_(modulus), steps_(static_cast<std::size_t>(count), 0) {}
  int size() const override { return static_cast<int>(steps_.size()); }
  int observation_size() const override { return 1; }
  int action_size() const override { return 1; }
  void Reset(std::uint64_t, Rows* observations) override {
    for (std::size_t i = 0; i < steps_.size(); ++i) steps_[i] = static_cast<int>(i) % length_;
    Observe(observations);
  }
  void Step(const Rows&, StepBatch* batch) override {
    batch->rewards.assign(steps_.size(), 1.0f);
    batch->terminated.assign(steps_.size(), 0);
    batch->truncated.assign(steps_.size(), 0);
    batch->success.assign(steps_.size(), 1);
    batch->last_observations.setConstant(size(), 1, -1.0f);
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      if (++steps_[i] < length_) continue;
      batch->truncated[i] = 1;
      batch->last_observations(static_cast<Eigen::Index>(i), 0) =
          static_cast<float>(steps_[i] % modulus_);
      steps_[i] = 0;
    }
    Observe(&batch->observations);
    if (blind_ >= 0) batch->observations(blind_, 0) = std::nanf("");
    blind_ = -1;
  }
  std::string SaveState() const override { return ""; }
  void RestoreState(std::string_view, Rows* observations) override { Observe(observations); }
  void Blind(int i) { blind_ = i; }

 private:
  void Observe(Rows* observations) const {
    observations->resize(size(), 1);
    for (int i = 0; i < size(); ++i) {
      (*observations)(i, 0) = static_cast<float>(steps_[static_cast<std::size_t>(i)] % modulus_);
    }
  }
  int length_, modulus_, blind_ = -1;
  std::vector<int> steps_;
};

Mlp ZeroActor() {
  return Mlp({{Eigen::MatrixXf::Zero(1, 1), Eigen::RowVectorXf::Zero(1)}}, Activation::kElu);
}

PpoOptions Options() {
  PpoOptions options;
  options.hidden = {16};
  options.horizon = 9;
  options.discount = 0.9;
  options.normalize_observations = false;
  options.scale_rewards = false;
  return options;
}

TEST(RolloutCollector, ATimeOutKeepsItsLastObservationAndItsPlace) {
  Counter environment(3, 5, 100);
  RolloutCollector collector(&environment, Options());
  Rollout rollout;
  std::vector<Outcome> outcomes;
  collector.Collect(ZeroActor(), Eigen::RowVectorXf::Constant(1, 0.5f), &rollout, &outcomes);
  // Environment i starts at step i, so that it ends at its steps 4 - i and 9 - i.
  const std::vector<std::size_t> expected = {2 * 3 + 2, 3 * 3 + 1, 4 * 3 + 0, 7 * 3 + 2, 8 * 3 + 1};
  EXPECT_EQ(rollout.last_rows, expected);
  ASSERT_EQ(rollout.last_observations.rows(), 5);
  EXPECT_TRUE((rollout.last_observations.array() == 5.0f).all());
  for (const std::size_t row : expected) EXPECT_EQ(rollout.truncated[row], 1);
  EXPECT_EQ(rollout.observations(0, 0), 0.0f);
  EXPECT_EQ(rollout.observations(2 * 3 + 2, 0), 4.0f);
  EXPECT_EQ(rollout.observations(3 * 3 + 2, 0), 0.0f);  // of the next episode
  EXPECT_EQ(rollout.next_observations(0, 0), 4.0f);
  ASSERT_EQ(outcomes.size(), 5u);
  EXPECT_EQ(outcomes[0].total_reward, 3.0);
  EXPECT_EQ(outcomes[3].total_reward, 5.0);
  EXPECT_EQ(outcomes[3].steps, 5.0);
  EXPECT_TRUE(outcomes[3].success);
}

TEST(RolloutCollector, WhatLeadsToABlindObservationAndWhatIsDoneBlindlyIsDropped) {
  Counter environment(3, 5, 100);
  PpoOptions options = Options();
  options.largest_dropped_share = 0.5;
  RolloutCollector collector(&environment, options);
  Rollout rollout;
  std::vector<Outcome> outcomes;
  environment.Blind(1);
  collector.Collect(ZeroActor(), Eigen::RowVectorXf::Constant(1, 0.5f), &rollout, &outcomes);
  EXPECT_EQ(collector.dropped(), 2);
  EXPECT_EQ(rollout.dropped[1], 1);
  EXPECT_EQ(rollout.dropped[3 + 1], 1);
  EXPECT_EQ(rollout.dropped[6 + 1], 0);
  EXPECT_TRUE(rollout.observations.allFinite());
}

// With a reward of 1 forever, every state is worth 1 / (1 - 0.9) = 10, at any of an episode's 10
// steps. A learner that treats time limits as terminations learns less than 6.5. Because of the
// modulus the last observation also occurs as an input: where the critic extrapolates, its errors
// would feed themselves.
TEST(PpoLearner, ItsCriticLearnsWhatAnEndlessTaskIsWorth) {
  Counter environment(16, 10, 4);
  PpoOptions options = Options();
  options.horizon = 40;
  options.minibatch = 160;
  options.target_kl = 0.0;
  RolloutCollector collector(&environment, options);
  PpoLearner learner({1, 1, options.hidden, options.activation}, options);
  Rollout rollout;
  std::vector<Outcome> outcomes;
  UpdateReport report;
  for (int iteration = 0; iteration < 60; ++iteration) {
    collector.Collect(learner.networks().Actor(), learner.networks().Std(), &rollout, &outcomes);
    report = learner.Update(rollout);
  }
  const torch::Tensor values = learner.networks().Values(torch::arange(0, 4.0).view({4, 1}));
  EXPECT_LT((values - 10.0).abs().max().item<double>(), 0.2) << values;
}

}  // namespace
}  // namespace simwright::rl
