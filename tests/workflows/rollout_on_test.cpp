#include <algorithm>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/workflows/program.h"
#include "tests/workflows/scripted_run.h"

namespace simwright::workflows {
namespace {

using nlohmann::json;

class RolloutOn : public ScriptedRuns {
 protected:
  static std::string TaskFile() { return (shared_->path() / "tasks.json").string(); }
};

// On its own scenes, --on reproduces the results without it exactly.
TEST_F(RolloutOn, OtherTasksAlikeAreActedIn) {
  const Outcome own = RunProgram("rollout --json --episodes 12 " + Pick());
  const Outcome on = RunProgram("rollout --json --episodes 12 " + Pick() + " --on " + TaskFile() +
                                " --task 'pick_up_*'");
  ASSERT_EQ(own.code, 0) << own.text;
  ASSERT_EQ(on.code, 0) << on.text;
  EXPECT_EQ(json::parse(on.text), json::parse(own.text));
  EXPECT_GT(json::parse(on.text).at("successes"), 6);
}

TEST_F(RolloutOn, TasksThatDoNotFitAreRefusedInOneLine) {
  for (const auto& [task, why] : std::vector<std::pair<std::string, std::string>>{
           {"fly_block", "there is no task 'fly_block'"}, {"move_block", "number of subtasks"}}) {
    const Outcome outcome =
        RunProgram("rollout --quiet " + Pick() + " --on " + TaskFile() + " --task " + task);
    EXPECT_EQ(outcome.code, 1) << task;
    EXPECT_NE(outcome.text.find(why), std::string::npos) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
  }
}

}  // namespace
}  // namespace simwright::workflows
