// Several ranks learn what one process learns.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "rl/gaussian_policy.h"
#include "rl/policy_file.h"
#include "rl/ppo.h"
#include "rl/ppo_learner.h"
#include "rl/shared_moments.h"
#include "rl/training.h"
#include "rl/training_log.h"
#include "tests/rl/inverted_pendulum.h"
#include "tests/rl/reach_environment.h"
#include "tests/rl/thread_ranks.h"
#include "tests/sanitized.h"

namespace simwright::rl {
namespace {

Rows RandomRows(int rows, int columns, double deviation, core::Rng& rng) {
  Rows random(rows, columns);
  for (float& value : random.reshaped()) value = static_cast<float>(deviation * core::Normal(rng));
  return random;
}

TEST(SharedMoments, AreThoseOfAllRows) {
  core::Rng rng(5);
  const Rows before = RandomRows(40, 3, 2.0, rng).array() + 7.0f;
  const Rows first = RandomRows(10, 3, 1.0, rng), second = RandomRows(25, 3, 5.0, rng);
  RunningMoments all(3), shared(3);
  for (const Rows* rows : {&before, &first, &second}) all.Add(*rows);
  shared.Add(before);
  ThreadRanks(2).Run([&](Communicator* ranks) {
    RunningMoments now = shared;
    now.Add(ranks->leads() ? first : second);
    const RunningMoments merged = MergedOverRanks(shared, now, ranks);
    EXPECT_EQ(merged.count, 75.0);
    EXPECT_LT((merged.mean - all.mean).abs().maxCoeff(), 1e-12);
    EXPECT_LT(((merged.squares - all.squares) / all.squares).abs().maxCoeff(), 1e-12);
  });
}

constexpr int kSteps = 24, kInputs = 3;

PpoOptions OneGradientStep() {
  PpoOptions options;
  options.hidden = {32, 32};
  options.epochs = 1;
  options.minibatch = 1 << 20;
  options.gradient_norm = 1e9;  // the gradient stays as it is
  return options;
}

// Returns random steps of `count` environments near the policy of `learner`.
Rollout RandomRollout(const PpoLearner& learner, int count) {
  core::Rng rng(11);
  Rollout rollout;
  rollout.Resize(kSteps, count, kInputs, 1);
  rollout.observations = RandomRows(kSteps * count, kInputs, 1.0, rng);
  rollout.next_observations = RandomRows(count, kInputs, 1.0, rng);
  rollout.std = learner.networks().Std();
  learner.networks().Actor().Forward(rollout.observations, &rollout.means);
  rollout.means += RandomRows(kSteps * count, 1, 0.1, rng);
  rollout.actions = rollout.means + RandomRows(kSteps * count, 1, 0.6, rng);
  const Eigen::VectorXf densities = LogDensity(rollout.actions, rollout.means, rollout.std);
  rollout.log_densities.assign(densities.begin(), densities.end());
  for (std::size_t i = 0; i < rollout.rewards.size(); ++i) {
    rollout.rewards[i] = static_cast<float>(core::Normal(rng));
    rollout.terminated[i] = core::Uniform(rng) < 0.05;
  }
  rollout.dropped[3] = 1;  // the ranks have different numbers of rows
  return rollout;
}

// Returns environments first, ... of a rollout.
Rollout PartOf(const Rollout& all, int first, int count) {
  Rollout part;
  part.Resize(kSteps, count, kInputs, 1);
  part.std = all.std;
  part.next_observations = all.next_observations.middleRows(first, count);
  for (int step = 0; step < kSteps; ++step) {
    const int from = step * all.environments + first, to = step * count;
    part.observations.middleRows(to, count) = all.observations.middleRows(from, count);
    part.means.middleRows(to, count) = all.means.middleRows(from, count);
    part.actions.middleRows(to, count) = all.actions.middleRows(from, count);
    for (int i = 0; i < count; ++i) {
      const auto source = static_cast<std::size_t>(from + i);
      const auto target = static_cast<std::size_t>(to + i);
      part.log_densities[target] = all.log_densities[source];
      part.rewards[target] = all.rewards[source];
      part.terminated[target] = all.terminated[source];
      part.dropped[target] = all.dropped[source];
    }
  }
  return part;
}

// Each of two ranks has half of the environments: the gradient is that of the whole minibatch.
TEST(PpoLearner, TheGradientOfRanksIsThatOfTheWholeMinibatch) {
  const PpoOptions options = OneGradientStep();
  const ActorCriticSizes sizes{kInputs, 1, options.hidden, options.activation};
  PpoLearner alone(sizes, options);
  const Rollout all = RandomRollout(alone, 16);
  const UpdateReport expected = alone.Update(all);
  const torch::Tensor whole = alone.networks().parameters().gradients().clone();
  ASSERT_GT(whole.norm().item<double>(), 0.1);
  for (const std::array<int, 2> counts : {std::array{8, 8}, std::array{5, 11}}) {
    ThreadRanks(2).Run([&](Communicator* ranks) {
      PpoLearner learner(sizes, options, ranks);
      const UpdateReport report = learner.Update(
          ranks->leads() ? PartOf(all, 0, counts[0]) : PartOf(all, counts[0], counts[1]));
      const torch::Tensor gradients = learner.networks().parameters().gradients();
      EXPECT_LT((gradients - whole).abs().max().item<double>(), 1e-6);
      EXPECT_NEAR(report.kl, expected.kl, 1e-6);
      EXPECT_NEAR(report.policy_loss, expected.policy_loss, 1e-6);
      EXPECT_NEAR(report.value_loss, expected.value_loss, 1e-6);
    });
  }
}

TEST(PpoLearner, NoticesRanksWhosePoliciesDiffer) {
  PpoOptions options = OneGradientStep();
  const ActorCriticSizes sizes{kInputs, 1, options.hidden, options.activation};
  const Rollout all = RandomRollout(PpoLearner(sizes, options), 4);
  int refused = 0;
  std::mutex mutex;
  ThreadRanks(2).Run([&](Communicator* ranks) {
    PpoOptions own = options;
    own.seed = ranks->leads() ? 1 : 2;  // of the initial weights
    PpoLearner learner(sizes, own, ranks);
    try {
      learner.Update(PartOf(all, 2 * ranks->rank(), 2));
    } catch (const core::Error& error) {
      const std::lock_guard lock(mutex);
      ++refused;
      EXPECT_NE(std::string(error.what()).find("rank 1"), std::string::npos) << error.what();
    }
  });
  EXPECT_EQ(refused, 2);
}

// Two ranks of 8 carts reach what inverted_pendulum_test.cpp asks of one process with 16.
TEST(Ppo, TwoRanksKeepAPoleUpright) {
  SKIP_UNDER_SANITIZERS();
  core::SetThreadCount(1);
  PpoOptions options;
  options.hidden = {64, 64};
  options.horizon = 128;
  options.minibatch = 512;
  std::array<std::optional<Policy>, 2> policies;
  ThreadRanks(2).Run([&](Communicator* ranks) {
    InvertedPendulum environment(8);
    Ppo ppo(&environment, options, ranks);
    std::vector<Outcome> outcomes;
    while (ppo.samples() < 50000) {
      ppo.Collect(&outcomes);
      ppo.Update();
    }
    EXPECT_EQ(ppo.samples() % (16 * 128), 0);
    policies[static_cast<std::size_t>(ranks->rank())] = ppo.CurrentPolicy();
  });
  Rows others;
  const double mean = MeanStepsUpright(20, 7, [&](const Rows& observations, Rows* actions) {
    policies[0]->Act(observations, actions);
    policies[1]->Act(observations, &others);
    ASSERT_TRUE((actions->array() == others.array()).all());
  });
  ASSERT_FALSE(HasFatalFailure());
  EXPECT_GE(mean, 950.0);
  core::SetThreadCount(0);
}

TrainingOptions RankTrainingOptions(int iterations) {
  TrainingOptions options;
  options.ppo.hidden = {16, 16};
  options.ppo.horizon = 32;
  options.ppo.minibatch = 128;
  options.max_samples = iterations * 16 * 32;
  options.success_window = 20;
  options.checkpoint_every = 3;
  return options;
}

// Trains 16 environments on `size` ranks.
void TrainOnRanks(int size, int iterations, const std::filesystem::path& folder, bool resume,
                  const TrainingListener& report = {}) {
  ThreadRanks(size).Run([&](Communicator* ranks) {
    ReachEnvironment environment(16 / size);
    TrainPolicy(&environment, RankTrainingOptions(iterations), folder, resume, report, {}, ranks);
  });
}

TEST(TrainPolicy, RanksThatWereKilledResumeBitForBit) {
  core::SetThreadCount(1);
  const core::TemporaryFolder folder;
  const auto whole = folder.path() / "whole", part = folder.path() / "part";
  TrainOnRanks(2, 8, whole, false);
  struct Killed {};
  const auto kill = [](const TrainingRecord& record) {
    if (record.iteration == 5) throw Killed();
  };
  EXPECT_THROW(TrainOnRanks(2, 8, part, false, kill), Killed);
  TrainOnRanks(2, 8, part, true);
  EXPECT_TRUE(core::ReadFile(whole / kPolicyFile) == core::ReadFile(part / kPolicyFile));
  const auto rows = ReadTrainingTable(whole / "training.csv", 1000);
  const auto resumed = ReadTrainingTable(part / "training.csv", 1000);
  ASSERT_EQ(rows.size(), 8u);
  ASSERT_EQ(resumed.size(), 8u);
  EXPECT_EQ(rows.back().mean_return, resumed.back().mean_return);
  EXPECT_EQ(rows.back().samples, 8.0 * 16 * 32);
  EXPECT_EQ(rows.back().episodes, resumed.back().episodes);
  // Another number of ranks goes on from the same networks.
  TrainOnRanks(4, 9, part, true);
  TrainOnRanks(1, 10, part, true);
  EXPECT_EQ(ReadTrainingTable(part / "training.csv", 1000).size(), 10u);
  core::SetThreadCount(0);
}

}  // namespace
}  // namespace simwright::rl
