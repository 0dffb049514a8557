// Whole trainings: interrupted, resumed, failing.
#include "rl/training.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "rl/event_file.h"
#include "rl/policy_file.h"
#include "rl/training_log.h"
#include "tests/rl/reach_environment.h"

namespace simwright::rl {
namespace {
namespace fs = std::filesystem;

constexpr int kEnvironments = 16;
constexpr std::int64_t kIteration = kEnvironments * 32;  // samples

TrainingOptions SmallTraining(int iterations) {
  TrainingOptions options;
  options.ppo.hidden = {16, 16};
  options.ppo.horizon = 32;
  options.ppo.minibatch = 128;
  options.max_samples = iterations * kIteration;
  options.success_window = 20;
  options.checkpoint_every = 3;
  options.metadata = {{"task", "reach"}};
  return options;
}

TrainingResult Train(const TrainingOptions& options, const fs::path& folder, bool resume,
                     const TrainingListener& report = {}, const Examiner& examine = {}) {
  core::SetThreadCount(2);
  ReachEnvironment environment(kEnvironments);
  return TrainPolicy(&environment, options, folder, resume, report, examine);
}

// Compares everything that does not depend on the clock, bit for bit.
void ExpectSameTraining(const fs::path& a, const fs::path& b) {
  const auto first = ReadTrainingTable(a / "training.csv", 1000);
  const auto second = ReadTrainingTable(b / "training.csv", 1000);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (const TrainingColumn& column : kTrainingColumns) {
      const std::string name = column.name;
      if (name == "seconds" || name == "samples_per_second" || name == "learner_share") continue;
      const double x = first[i].*column.value, y = second[i].*column.value;
      EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y)))
          << name << " of iteration " << i + 1 << ": " << x << " and " << y;
    }
  }
  // No EXPECT_EQ: it would print both.
  EXPECT_TRUE(core::ReadFile(a / kPolicyFile) == core::ReadFile(b / kPolicyFile));
}

float LargestDifference(const Mlp& a, const Mlp& b) {
  float largest = 0.0f;
  for (std::size_t i = 0; i < a.layers().size(); ++i) {
    const Mlp::Layer &x = a.layers().at(i), &y = b.layers().at(i);
    largest = std::max({largest, (x.weights - y.weights).cwiseAbs().maxCoeff(),
                        (x.bias - y.bias).cwiseAbs().maxCoeff()});
  }
  return largest;
}

class TrainingTest : public testing::Test {
 protected:
  void SetUp() override {
    Train(SmallTraining(8), whole_, false);
    ASSERT_EQ(ReadTrainingTable(whole_ / "training.csv", 1000).size(), 8u);
  }
  core::TemporaryFolder folder_;
  fs::path whole_ = folder_.path() / "whole", part_ = folder_.path() / "part";
};

// A training that begins from another training's checkpoint starts with that one's final network,
// and counts from zero.
TEST_F(TrainingTest, OneBeginsWithWhatAnotherHasLearnt) {
  TrainingOptions options = SmallTraining(1);
  options.ppo.epochs = 1;
  options.ppo.minibatch = kIteration;  // one step: no weight moves further than the rate
  options.metadata = {{"task", "another"}};
  options.begin_from = whole_ / kCheckpointFile;
  const fs::path begun = folder_.path() / "begun";
  const TrainingResult result = Train(options, begun, false);
  EXPECT_EQ(result.last.samples, kIteration);
  EXPECT_EQ(result.last.iteration, 1.0);
  const Policy known = ReadPolicy(whole_ / kPolicyFile), first = ReadPolicy(begun / kPolicyFile);
  EXPECT_EQ(first.metadata().at("task"), "another");
  EXPECT_LT(LargestDifference(known.actor(), first.actor()), 2.0 * options.ppo.largest_rate);
  options.begin_from.clear();
  Train(options, folder_.path() / "fresh", false);
  const Policy fresh = ReadPolicy(folder_.path() / "fresh" / kPolicyFile);
  EXPECT_GT(LargestDifference(known.actor(), fresh.actor()), 0.1f);

  options.begin_from = whole_ / kCheckpointFile;
  options.ppo.hidden = {8};
  EXPECT_THROW(Train(options, folder_.path() / "other", false), core::Error);
}

TEST_F(TrainingTest, OneThatWasStoppedGoesOnAsIfItHadNotBeen) {
  EXPECT_EQ(Train(SmallTraining(5), part_, false).end, TrainingEnd::kSamples);
  EXPECT_THROW(Train(SmallTraining(8), part_, false), core::Error);  // would be overwritten
  const TrainingResult result = Train(SmallTraining(8), part_, true);
  EXPECT_EQ(result.last.iteration, 8.0);
  EXPECT_EQ(result.last.samples, 8.0 * kIteration);
  ExpectSameTraining(whole_, part_);
}

// A training killed after iteration 5 has rows that its last checkpoint, after iteration 3, lacks.
TEST_F(TrainingTest, OneThatWasKilledRepeatsWhatItsCheckpointDoesNotKnow) {
  struct Killed {};
  EXPECT_THROW(Train(SmallTraining(8), part_, false,
                     [](const TrainingRecord& record) {
                       if (record.iteration == 5) throw Killed();
                     }),
               Killed);
  ASSERT_EQ(ReadTrainingTable(part_ / "training.csv", 1000).size(), 5u);
  Train(SmallTraining(8), part_, true);
  ExpectSameTraining(whole_, part_);
  const std::string events = core::ReadFile(part_ / "events.out.tfevents.0.simwright");
  EXPECT_EQ(EventsUpTo(events, 8), events.size());
  EXPECT_EQ(events.size(), core::ReadFile(whole_ / "events.out.tfevents.0.simwright").size());
}

TEST_F(TrainingTest, AFullDiskKeepsTheLastCheckpoint) {
  Train(SmallTraining(5), part_, false);
  const std::string checkpoint = core::ReadFile(part_ / kCheckpointFile);
  rlimit limit{}, old{};
  getrlimit(RLIMIT_FSIZE, &old);
  limit = old;
  limit.rlim_cur = checkpoint.size() - 1;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &limit);
  EXPECT_THROW(Train(SmallTraining(8), part_, true), core::Error);
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(core::ReadFile(part_ / kCheckpointFile), checkpoint);
  int files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(part_)) ++files;
  EXPECT_EQ(files, 5);  // no temporary file beside the five
  Train(SmallTraining(8), part_, true);
  ExpectSameTraining(whole_, part_);
}

TEST_F(TrainingTest, ACheckpointOfAnotherTrainingIsRefusedSayingWhatDiffers) {
  const auto refusal = [&](auto change) -> std::string {
    TrainingOptions options = SmallTraining(9);
    change(&options);
    try {
      Train(options, whole_, true);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_NE(refusal([](TrainingOptions* o) {
              o->metadata["task"] = "open";
            }).find("its task is 'reach', expected 'open'"),
            std::string::npos);
  EXPECT_NE(refusal([](TrainingOptions* o) {
              o->ppo.hidden = {16, 8};
            }).find("its hidden is '16-16', expected '16-8'"),
            std::string::npos);
  ReachEnvironment more(kEnvironments + 1);
  EXPECT_THROW(TrainPolicy(&more, SmallTraining(9), whole_, true), core::Error);
  const std::string bytes = core::ReadFile(whole_ / kCheckpointFile);
  std::string newer = bytes;
  const std::size_t at = newer.find("version=2");
  ASSERT_NE(at, std::string::npos);
  newer[at + 8] = '3';
  core::WriteFile(whole_ / kCheckpointFile, newer);
  EXPECT_NE(refusal([](TrainingOptions*) {}).find("its version is '3', expected '2'"),
            std::string::npos);
  for (const double share : {0.0, 0.1, 0.5, 0.9, 0.999}) {
    const auto length = static_cast<std::size_t>(share * static_cast<double>(bytes.size()));
    core::WriteFile(whole_ / kCheckpointFile, bytes.substr(0, length));
    EXPECT_NE(refusal([](TrainingOptions*) {}).find(kCheckpointFile), std::string::npos) << share;
  }
}

TEST(Training, EndsWhenTheSuccessIntervalsLowerEndHasReachedTheTarget) {
  const core::TemporaryFolder folder;
  TrainingOptions options = SmallTraining(200);
  options.success_window = 100;
  options.success_target = 0.7;
  const TrainingResult result = Train(options, folder.path() / "run", false);
  EXPECT_EQ(result.end, TrainingEnd::kSuccess);
  EXPECT_GE(result.last.success_low, 0.7);
  EXPECT_GT(result.last.success, 0.78);  // of 100 episodes, 79 give a lower end of 0.70
  const auto records = ReadTrainingTable(folder.path() / "run/training.csv", 1000);
  EXPECT_LT(records[records.size() - 2].success_low, 0.7);

  const Policy policy = ReadPolicy(folder.path() / "run" / kPolicyFile);
  EXPECT_EQ(policy.metadata().at("task"), "reach");
  EXPECT_GT(fs::file_size(folder.path() / "run" / kCurvesFile), 2000u);
}

// An examiner with a given sequence of rates, of 100 episodes.
class Examinations {
 public:
  explicit Examinations(std::vector<int> successes) : successes_(std::move(successes)) {}
  Examination operator()(const Policy& policy) {
    policies_.push_back(PolicyBytes(policy));
    return {successes_.at(policies_.size() - 1), 100};
  }
  const std::vector<std::string>& policies() const { return policies_; }
  static std::string PolicyBytes(const Policy& policy) {
    const core::TemporaryFolder folder;
    WritePolicy(policy, folder.path() / "p.pt");
    return core::ReadFile(folder.path() / "p.pt");
  }

 private:
  std::vector<int> successes_;
  std::vector<std::string> policies_;
};

TrainingOptions ExaminedTraining(int iterations) {
  TrainingOptions options = SmallTraining(iterations);
  options.examine_every = 2;
  options.examine_from = 0.0;
  options.success_target = 0.9;  // of 100, 96 give a lower end of 0.902, 95 one of 0.888
  return options;
}

TEST(Training, KeepsTheBestPolicyThatWasExamined) {
  const core::TemporaryFolder folder;
  Examinations examinations({10, 60, 30, 20, 15, 5});
  const TrainingResult result =
      Train(ExaminedTraining(9), folder.path() / "run", false, {}, std::ref(examinations));
  EXPECT_EQ(result.end, TrainingEnd::kSamples);
  EXPECT_EQ(result.last.examined, examinations.policies().size() == 4 ? 0.20 : 0.15);
  const Policy kept = ReadPolicy(folder.path() / "run" / kPolicyFile);
  EXPECT_TRUE(Examinations::PolicyBytes(kept) == examinations.policies()[1]);
  EXPECT_FALSE(Examinations::PolicyBytes(kept) == examinations.policies().back());
}

TEST(Training, WhatItBeginsWithMayBeGoodAlready) {
  const core::TemporaryFolder folder;
  Examinations good({97});
  const TrainingResult result =
      Train(ExaminedTraining(40), folder.path() / "good", false, {}, std::ref(good));
  EXPECT_EQ(result.end, TrainingEnd::kSuccess);
  EXPECT_EQ(result.last.iteration, 1.0);
  TrainingOptions later = ExaminedTraining(1);
  later.examine_from = 0.35;
  Examinations none({50});  // the last iteration is always examined
  const TrainingResult other = Train(later, folder.path() / "later", false, {}, std::ref(none));
  EXPECT_EQ(other.end, TrainingEnd::kSamples);
  EXPECT_EQ(none.policies().size(), 1u);
}

TEST(Training, EndsWithTheExaminationThatReachesTheTarget) {
  const core::TemporaryFolder folder;
  Examinations examinations({95, 96, 100});
  const TrainingResult result =
      Train(ExaminedTraining(40), folder.path() / "run", false, {}, std::ref(examinations));
  EXPECT_EQ(result.end, TrainingEnd::kSuccess);
  EXPECT_EQ(examinations.policies().size(), 2u);
  EXPECT_EQ(result.last.examined, 0.96);
  // Resumed, it ends at once.
  const TrainingResult again =
      Train(ExaminedTraining(40), folder.path() / "run", true, {}, std::ref(examinations));
  EXPECT_EQ(again.end, TrainingEnd::kSuccess);
  EXPECT_EQ(again.last.iteration, result.last.iteration);
  EXPECT_EQ(examinations.policies().size(), 2u);
}

// Ctrl-C is sent to a child process, since it cannot be undone.
TEST(TrainingDeathTest, CtrlCEndsAfterTheIterationWithACheckpoint) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const core::TemporaryFolder folder;
  const auto stop = [&] {
    try {
      Train(SmallTraining(8), folder.path(), false, [](const TrainingRecord& record) {
        if (record.iteration == 1) core::RequestCancel();
      });
    } catch (const core::Cancelled&) {
      const bool kept = fs::exists(folder.path() / kCheckpointFile);
      _exit(kept ? 5 : 6);
    }
    _exit(7);
  };
  EXPECT_EXIT(stop(), testing::ExitedWithCode(5), "");
}

TEST(Training, OptionsThatNoTrainingCanHaveLeaveNoFolder) {
  const core::TemporaryFolder folder;
  TrainingOptions options = SmallTraining(3);
  options.success_target = 1.0;
  EXPECT_THROW(Train(options, folder.path() / "run", false), core::Error);
  EXPECT_FALSE(fs::exists(folder.path() / "run"));
}

}  // namespace
}  // namespace simwright::rl
