// `simwright check --profile simready`: what passes, and damaged assets that do not.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <string>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "tests/workflows/program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

class SimReady : public ::testing::Test {
 protected:
  fs::path Make(const std::string& kind) const {
    EXPECT_EQ(
        RunProgram("library --kind " + kind + " --no-check --quiet -o " + folder_.path().string())
            .code,
        0);
    return folder_.path() / (kind + "_1");
  }

  // Replaces a pattern in the asset's MJCF file.
  static void Damage(const fs::path& asset, const std::string& pattern, const std::string& by) {
    const fs::path file = asset / (asset.filename().string() + ".xml");
    const std::string text = core::ReadFile(file);
    const std::string damaged = std::regex_replace(text, std::regex(pattern), by);
    ASSERT_NE(text, damaged);
    core::WriteFile(file, damaged);
  }

  // Returns the verdicts by property; "" is the whole asset's.
  static std::map<std::string, std::string> Examine(const fs::path& asset) {
    const Outcome outcome =
        RunProgram("check --profile simready --json " + asset.string(), "/dev/null");
    const auto report = nlohmann::json::parse(outcome.text)["reports"][0];
    std::map<std::string, std::string> verdicts;
    for (const auto& row : report["rows"]) verdicts[row["property"]] = row["verdict"];
    verdicts[""] = report["grade"];
    EXPECT_EQ(outcome.code, verdicts[""] == "fail" ? 1 : 0);
    return verdicts;
  }

  const core::TemporaryFolder folder_;
};

TEST_F(SimReady, AMugPassesInBothEngines) {
  auto verdicts = Examine(Make("mug"));
  EXPECT_NE(verdicts[""], "fail");
  for (const std::string engine : {"bullet", "mujoco"}) {
    for (const std::string exam : {"drop-far-", "slope-", "slides-", "stack-", "grasp-"}) {
      ASSERT_TRUE(verdicts.contains(exam + engine)) << exam << engine;
      EXPECT_NE(verdicts[exam + engine], "FAIL") << exam << engine;
    }
  }
}

TEST_F(SimReady, ASlipperyMjcfFailsInMujocoAlone) {
  const fs::path asset = Make("box");
  Damage(asset, "friction=\"[0-9.]+", "friction=\"0.03");
  auto verdicts = Examine(asset);
  EXPECT_EQ(verdicts[""], "fail");
  EXPECT_EQ(verdicts["slope-mujoco"], "FAIL");
  EXPECT_EQ(verdicts["slope-bullet"], "pass");
}

TEST_F(SimReady, AnMjcfWithoutContactsFallsThroughTheFloor) {
  const fs::path asset = Make("box");
  Damage(asset, "group=\"3\"", "group=\"3\" contype=\"0\" conaffinity=\"0\"");
  auto verdicts = Examine(asset);
  EXPECT_EQ(verdicts["drop-far-mujoco"], "FAIL");
  EXPECT_EQ(verdicts["stack-mujoco"], "FAIL");
  EXPECT_EQ(verdicts["drop-far-bullet"], "pass");
}

TEST_F(SimReady, WhatNoGripperHoldsSaysWhy) {
  const Outcome outcome = RunProgram("check --profile simready " + Make("tissue_box").string());
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("it is wider than the hand"), std::string::npos) << outcome.text;
  EXPECT_EQ(RunProgram("check --profile simpleready x").code, 2);
}

}  // namespace
}  // namespace simwright
