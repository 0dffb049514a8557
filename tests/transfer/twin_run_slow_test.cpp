#include "transfer/twin_run.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <nlohmann/json.hpp>

#include "block_twin.h"
#include "core/files.h"

namespace simwright::transfer {
namespace {

int Count(const core::Findings& findings, const std::string& code) {
  return static_cast<int>(
      std::count_if(findings.begin(), findings.end(),
                    [&](const core::Finding& finding) { return finding.code == code; }));
}

// A run, resumed: the tasks, their findings and the training stay.
TEST(RunTwin, KeepsTheFindingsOfItsTasks) {
  const core::TemporaryFolder folder;
  // The second block is out of reach.
  WriteBlockTwin(folder.path() / "twin", {{-0.08, 0.7, 0.3}, {0.0, 2.2, 0.0}});
  TwinRunRequest request;
  request.twin = folder.path() / "twin";
  request.robot = Eigen::Vector3d(0.0, 0.2, 1.5708);
  request.output = folder.path() / "run";
  request.worlds = 4;
  request.train.action = skills::ActionSpace::kGuided;
  request.train.environments = 8;
  request.train.samples = 2048;
  request.train.episodes = 6;
  core::Progress silent;
  const TwinRunOutcome first = RunTwin(request, &silent);
  const std::string tasks = core::ReadFile(request.output / "tasks.json");
  const std::string skill = core::ReadFile(request.output / "skill/run.json");
  std::filesystem::remove(request.output / "report.json");
  request.resume = true;
  const TwinRunOutcome again = RunTwin(request, &silent);
  EXPECT_EQ(Count(again.findings, "twin-robot-placed"), 1);
  EXPECT_EQ(Count(again.findings, "twin-out-of-reach"), 1);
  EXPECT_EQ(TwinRunJson(again), TwinRunJson(first));
  EXPECT_EQ(core::ReadFile(request.output / "tasks.json"), tasks);
  EXPECT_EQ(core::ReadFile(request.output / "skill/run.json"), skill);
  const auto report = nlohmann::json::parse(core::ReadFile(request.output / "report.json"));
  EXPECT_EQ(report.at("findings").front().at("code"), "twin-robot-placed");
}

}  // namespace
}  // namespace simwright::transfer
