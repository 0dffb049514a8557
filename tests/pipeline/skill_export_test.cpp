// `export` and `replay`: a scripted skill is rolled out, leaves as a robot's trajectory or as
// demonstrations, and does its task again from the file alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "pipeline/skill_demonstrations.h"
#include "pipeline/skill_export.h"
#include "pipeline/skill_replay.h"
#include "pipeline/trajectory_replay.h"
#include "program.h"
#include "robot/trajectory_file.h"
#include "scripted_run.h"

namespace simwright::pipeline {
namespace {
namespace fs = std::filesystem;

class SkillExport : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new core::TemporaryFolder;
    WriteScriptedRun(shared_->path(), "pick_up_block");
    WriteScriptedRun(shared_->path(), "move_block");
  }
  static void TearDownTestSuite() { delete shared_; }

  static std::string Pick() { return (shared_->path() / "pick_up_block").string(); }
  static std::string Move() { return (shared_->path() / "move_block").string(); }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  static core::TemporaryFolder* shared_;
  core::TemporaryFolder folder_;
  core::Progress silent_;
};
core::TemporaryFolder* SkillExport::shared_ = nullptr;

TEST_F(SkillExport, ARecordingHasTheEvaluationsOutcomes) {
  const TrainedTask task(Move());
  const rl::ChainEvaluation evaluation = rl::EvaluateChain(task.links(), 10, 5);
  EXPECT_GE(evaluation.successes, 8);  // the script is good at it
  for (int i = 0; i < 10; ++i) {
    const ChainRecording recording = RecordEpisode(task.links(), 5, static_cast<std::uint64_t>(i));
    const rl::ChainOutcome& outcome = evaluation.outcomes[static_cast<size_t>(i)];
    EXPECT_EQ(recording.success, outcome.success);
    ASSERT_EQ(recording.subtasks.size(), outcome.links.size());
    for (size_t k = 0; k < outcome.links.size(); ++k) {
      EXPECT_EQ(recording.subtasks[k].success, outcome.links[k].success);
      EXPECT_NEAR(recording.subtasks[k].decisions.size() * 0.05, outcome.links[k].seconds, 1e-9);
    }
  }
}

}  // namespace
}  // namespace simwright::pipeline
