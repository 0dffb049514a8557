// `simwright export --format onnx|torchscript`: policies as files that other libraries run.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/dnn.hpp>

#include "core/random.h"
#include "rl/policy_file.h"
#include "tests/workflows/program.h"
#include "tests/workflows/scripted_run.h"
#include "workflows/skills/skill_suite.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

using nlohmann::json;

// OpenCV reads the file and gives the actions of `policy`.
void ExpectSameActions(const rl::Policy& policy, const fs::path& file) {
  cv::dnn::Net net = cv::dnn::readNetFromONNX(file.string());
  core::Rng rng(3);
  for (int i = 0; i < 20; ++i) {
    rl::Rows observation(1, policy.observation_size()), expected;
    for (float& value : observation.reshaped()) {
      value = static_cast<float>(core::Uniform(rng, -1.5, 1.5));
    }
    policy.Act(observation, &expected);
    net.setInput(cv::Mat(1, policy.observation_size(), CV_32F, observation.data()));
    const cv::Mat action = net.forward();
    ASSERT_EQ(static_cast<int>(action.total()), policy.action_size());
    for (int a = 0; a < policy.action_size(); ++a) {
      EXPECT_NEAR(action.at<float>(0, a), expected(0, a), 1e-6) << i << " " << a;
    }
  }
}

class PolicyExportCommand : public ScriptedRuns {
 protected:
  static void ExpectRefused(const std::string& arguments, int code, const std::string& says) {
    const Outcome outcome = RunProgram("export " + arguments);
    EXPECT_EQ(outcome.code, code) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find(says), std::string::npos) << outcome.text;
  }
};

TEST_F(PolicyExportCommand, AShippedPolicyActsTheSameInOpenCv) {
  const std::string file = Path("pick.onnx");
  const Outcome outcome =
      RunProgram("export --skill pick_up_cup --format onnx --json -o " + file, "/dev/null");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const json metadata = json::parse(outcome.text).at("policies").at(0).at("metadata");
  EXPECT_EQ(metadata.at("task"), "pick_up_cup");
  EXPECT_EQ(metadata.at("robot"), "panda");
  EXPECT_EQ(metadata.at("action_space"), "focus");
  EXPECT_EQ(metadata.at("observation_size"), "62");
  EXPECT_EQ(metadata.at("action_size"), "7");
  EXPECT_EQ(metadata.at("control_rate_hz"), "20");
  ExpectSameActions(
      rl::ReadPolicy(ShippedPolicy(fs::path(SIMWRIGHT_SOURCE_DIR) / "models", "pick_up_cup")),
      file);
}

TEST_F(PolicyExportCommand, ARunOfSeveralSubtasksGivesAFolder) {
  ASSERT_EQ(RunProgram("export " + Move() + " --format onnx -o " + Path("all")).code, 0);
  for (const char* name : {"pick_up_block", "put_down_block"}) {
    const int number = name == std::string("pick_up_block") ? 1 : 2;
    ExpectSameActions(
        rl::ReadPolicy(fs::path(Move()) / (std::to_string(number) + "_" + name) / rl::kPolicyFile),
        Path("all") + "/" + name + ".onnx");
  }
  const std::string one = Path("put.pt");
  ASSERT_EQ(
      RunProgram("export " + Move() + " --subtask put_down_block --format torchscript -o " + one)
          .code,
      0);
  EXPECT_GT(fs::file_size(one), 1000u);
}

TEST_F(PolicyExportCommand, WrongRequestsAreRefusedInOneLine) {
  ExpectRefused("--format onnx -o a.onnx", 2, "--skill NAME is required");
  ExpectRefused(Pick() + " --skill pick_up_cup --format onnx -o a.onnx", 2, "excludes");
  ExpectRefused("--skill pick_up_cup --format csv -o a.csv", 2, "needs --format onnx");
  ExpectRefused("--skill pick --format onnx -o a.onnx", 1, "choose one of");
  ExpectRefused("--skill pick_up_cup --format onnx -o " + Path("a.pt"), 1,
                "the extension must be .onnx");
  ExpectRefused(Move() + " --subtask fly --format onnx -o a.onnx", 1,
                "it has pick_up_block, put_down_block");
  ExpectRefused(Path("") + " --format onnx -o a.onnx", 1, "is not a training folder");
  core::WriteFile(Path("old.onnx"), "old");
  ExpectRefused("--skill pick_up_cup --format onnx -o " + Path("old.onnx"), 1, "--force");
}

}  // namespace
}  // namespace simwright::workflows
