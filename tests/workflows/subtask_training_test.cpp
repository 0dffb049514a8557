// The progress report of a training: the remaining time, and the learning method of its policy.
#include "workflows/skills/subtask_training.h"

#include <gtest/gtest.h>

#include <string>

namespace simwright::workflows {
namespace {

rl::TrainingRecord After(double samples, double seconds) {
  rl::TrainingRecord record;
  record.samples = samples;
  record.seconds = seconds;
  return record;
}

// 2,000,000 decisions at 1000 per second take 2000 s; the limit of 30 minutes is lower.
TEST(TimeLeft, IsThatOfTheStepsOrOfTheMinutesWhateverEndsFirst) {
  rl::TrainingOptions options;
  options.max_samples = 2'000'000;
  options.max_seconds = 1800.0;
  EXPECT_NEAR(TimeLeft(After(100e3, 100.0), options), 1700.0, 1e-6);  // 1900 by steps
  options.max_seconds = 0.0;                                          // unlimited
  EXPECT_NEAR(TimeLeft(After(100e3, 100.0), options), 1900.0, 1e-6);
  options.max_seconds = 1800.0;
  options.max_samples = 200'000;
  EXPECT_NEAR(TimeLeft(After(100e3, 100.0), options), 100.0, 1e-6);
  EXPECT_EQ(TimeLeft(After(250e3, 100.0), options), 0.0);
  EXPECT_EQ(TimeLeft(After(1e3, 1900.0), options), 0.0);
}

rl::PpoOptions Imitating(std::int64_t samples) {
  rl::PpoOptions options;
  options.horizon = 64;
  options.imitated_samples = samples;
  return options;
}

TrainedSkill Learnt(std::int64_t samples, const LearningShares& shares) {
  TrainedSkill skill;
  skill.samples = samples;
  skill.shares = shares;
  return skill;
}

TEST(LearningShares, AreWhatThePolicyLearntBy) {
  constexpr auto kTargetFrame = skills::ActionSpace::kTargetFrame;
  // Batches of 4096: the 16th ends at 65,536.
  EXPECT_EQ(SharesOf(40960, Imitating(65536), 64, kTargetFrame).imitated, 40960);
  EXPECT_EQ(SharesOf(81920, Imitating(65536), 64, kTargetFrame).imitated, 65536);
  EXPECT_EQ(SharesOf(81920, Imitating(65537), 64, kTargetFrame).imitated, 69632);
  EXPECT_EQ(SharesOf(81920, Imitating(0), 64, kTargetFrame).imitated, 0);
  // There is no scripted expert for joint actions.
  EXPECT_EQ(SharesOf(81920, Imitating(65536), 64, skills::ActionSpace::kJoints).imitated, 0);
  rl::PpoOptions guided = Imitating(65536);
  guided.critic_samples = 5 * 4096;
  const LearningShares shares = SharesOf(4096, guided, 64, skills::ActionSpace::kGuided);
  EXPECT_EQ(shares.imitated, 0);
  EXPECT_EQ(shares.critic_alone, 4096);
  EXPECT_EQ(SharesOf(81920, guided, 64, skills::ActionSpace::kGuided).critic_alone, 20480);
}

TEST(LearningShares, AreSaidWithoutPpoWhereThereWasNone) {
  EXPECT_EQ(Learnt(40960, {40960, 0}).Method(), "imitation of a scripted expert");
  EXPECT_EQ(Learnt(81920, {65536, 0}).Method(),
            "imitation of a scripted expert (66k decisions), then PPO");
  EXPECT_EQ(Learnt(81920, {0, 0}).Method(), "PPO");
  EXPECT_EQ(Learnt(4096, {0, 4096}).Method(), "a scripted expert");
  EXPECT_EQ(Learnt(81920, {0, 20480}).Method(), "a scripted expert (20k decisions), then PPO");
}

}  // namespace
}  // namespace simwright::workflows
