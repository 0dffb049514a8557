// Tasks, training, export and the transfer check of a twin by the commands, and rejected inputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include <nlohmann/json.hpp>

#include "block_twin.h"
#include "core/files.h"
#include "tests/workflows/program.h"

namespace simwright {
namespace {

class TwinUse : public testing::Test {
 protected:
  TwinUse() {
    transfer::WriteBlockTwin(folder_.path() / "twin", {{-0.08, 0.7, 0.3}, {0.14, 0.75, -0.6}});
  }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  // One line "error: ..." with `word`.
  void ExpectRefused(const std::string& arguments, int code, const std::string& word) const {
    const Outcome outcome = RunProgram(arguments + " --quiet");
    EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.text;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find(word), std::string::npos) << word << "\n" << outcome.text;
  }

  core::TemporaryFolder folder_;
};

TEST_F(TwinUse, GoesFromATwinToACheckedTrajectory) {
  const Outcome tasks =
      RunProgram("tasks --twin " + Path("twin") + " -o " + Path("tasks.json") + " --json");
  ASSERT_EQ(tasks.code, 0) << tasks.text;
  const Outcome trained =
      RunProgram("train " + Path("tasks.json") + " --task pick_up_block_1 --twin " + Path("twin") +
                 " --sigmas 1.5 --action guided --envs 8 --steps 2048 --episodes 6 -o " +
                 Path("pick") + " --quiet");
  ASSERT_EQ(trained.code, 0) << trained.text;
  const auto run = nlohmann::json::parse(core::ReadFile(Path("pick/run.json")));
  EXPECT_DOUBLE_EQ(run.at("placement_ranges").at("block_2").at(0), 1.5 * 0.004);
  EXPECT_DOUBLE_EQ(run.at("placement_ranges").at("block_2").at(1), 1.5 * 0.05);
  const Outcome exported = RunProgram("export " + Path("pick") + " --format ros2 --twin " +
                                      Path("twin") + " -o " + Path("pick.yaml") + " --json");
  ASSERT_EQ(exported.code, 0) << exported.text;
  EXPECT_GE(nlohmann::json::parse(exported.text).at("recorded"), 8);
  const std::string check = "replay " + Path("pick.yaml") + " --twin " + Path("twin") +
                            " --worlds 12 --seed 4 --json --threads ";
  const Outcome checked = RunProgram(check + "2");
  ASSERT_EQ(checked.code, 0) << checked.text;
  EXPECT_EQ(checked.text, RunProgram(check + "1").text);
  const auto report = nlohmann::json::parse(checked.text);
  EXPECT_EQ(report.at("replay").at("worlds"), 12);
  EXPECT_GE(report.at("replay").at("successes"), 9);
  EXPECT_GE(report.at("policy").at("successes"), 9);
}

TEST_F(TwinUse, RefusesInOneLine) {
  const std::string output = " -o " + Path("out");
  ExpectRefused("tasks --twin " + Path("none") + output, 1, "the folder holds no twin");
  ExpectRefused("tasks" + output, 2, "--twin");
  ExpectRefused("tasks " + Path("twin/assets") + " --twin " + Path("twin") + output, 2, "twin");
  ExpectRefused("tasks --twin " + Path("twin") + " --base 9,9,0" + output, 1, "reaches none");
  ExpectRefused("run --twin " + Path("none") + output, 1, "the folder holds no twin");
  ExpectRefused("run --twin " + Path("twin") + " --category mug" + output, 2, "--category");
  ExpectRefused("run --twin " + Path("twin") + " --task dance" + output, 1, "no task 'dance'");
  ExpectRefused("run" + output, 2, "--twin");
  ExpectRefused("replay none.yaml --twin " + Path("twin"), 1, "none.yaml");
  ExpectRefused("replay none.yaml --worlds 5", 2, "--twin");
  ExpectRefused("export " + Path("none") + " --format onnx --twin " + Path("twin") + output, 2,
                "--twin");
}

}  // namespace
}  // namespace simwright
