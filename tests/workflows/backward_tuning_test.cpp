// Backward tuning of a subtask: it starts from the current policy, is kept only if both subtasks
// together improve, and is not repeated.
#include "workflows/skills/backward_tuning.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.h"
#include "core/files.h"
#include "rl/training.h"
#include "scripted_run.h"
#include "workflows/skills/subtask_training.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

class BackwardTuningTest : public testing::Test {
 protected:
  BackwardTuningTest() {
    run_ = ReadRun(WriteScriptedRun(folder_.path(), "move_block"));
    run_.environments = 4;
    skills_ = PrepareSkills(run_);
    request_.backward_samples = 512;
  }
  // A checkpoint of one iteration, as the first subtask's training would leave it.
  void WriteFirstCheckpoint() {
    skills::SkillEnvironment environment(skills_[0].skill, run_.environments);
    rl::TrainingOptions options = OptionsFor(request_, run_, skills_[0]);
    options.max_samples = 1;
    rl::TrainPolicy(&environment, options, folder_.path() / "once", false);
    fs::copy_file(folder_.path() / "once" / rl::kCheckpointFile,
                  skills_[0].folder / rl::kCheckpointFile);
  }
  TunedPair Pair() {
    const rl::Policy first = rl::ReadPolicy(skills_[0].folder / rl::kPolicyFile);
    const rl::Policy second = rl::ReadPolicy(skills_[1].folder / rl::kPolicyFile);
    const auto own = skills::Evaluate(*skills_[0].evaluated, first,
                                      skills::SampleStarts(*skills_[0].evaluated, 12, 3));
    const auto ends = SuccessfulEnds(own);
    EXPECT_GT(ends.size(), 4u);
    return {&skills_[0],
            &skills_[1],
            {},
            skills::Evaluate(*skills_[1].evaluated, second,
                             ReplannedStarts(*skills_[1].evaluated, ends, 1))
                .episodes};
  }

  core::TemporaryFolder folder_;
  SkillRun run_;
  std::vector<RunSkill> skills_;
  TrainRequest request_;
  core::Progress silent_;
};

TEST_F(BackwardTuningTest, WhatGainsNothingIsNotKeptAndNotTriedAgain) {
  WriteFirstCheckpoint();
  const std::string policy = core::ReadFile(skills_[0].folder / rl::kPolicyFile);
  EXPECT_FALSE(ReadBackwardTuning(skills_[0]));
  // The scripted expert nearly always succeeds; a policy from an untrained checkpoint does not.
  const BackwardTuning tuning = TuneBackward(request_, run_, Pair(), &silent_);
  EXPECT_GE(tuning.samples, 512);
  EXPECT_GT(tuning.before, 0.8);
  EXPECT_LT(tuning.after, tuning.before);
  EXPECT_FALSE(tuning.kept);
  EXPECT_EQ(core::ReadFile(skills_[0].folder / rl::kPolicyFile), policy);
  EXPECT_TRUE(fs::exists(skills_[0].folder / "backward" / rl::kPolicyFile));

  fs::remove_all(skills_[0].folder / "backward");
  const BackwardTuning again = TuneBackward(request_, run_, Pair(), &silent_);
  EXPECT_EQ(again.after, tuning.after);
  EXPECT_FALSE(fs::exists(skills_[0].folder / "backward"));  // nothing was trained
  core::WriteFile(skills_[0].folder / "backward.json", "{}");
  EXPECT_THROW(ReadBackwardTuning(skills_[0]), core::Error);
}

TEST_F(BackwardTuningTest, WithoutACheckpointItSaysSo) {
  try {
    TuneBackward(request_, run_, Pair(), &silent_);
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find(rl::kCheckpointFile), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace simwright::workflows
