// `simwright check FOLDER` on a folder of assets: one line each, exit code 1 if one fails.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "tests/workflows/program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

TEST(CheckFolder, GivesALineAnAssetAndFailsWithTheWorst) {
  const core::TemporaryFolder folder;
  const fs::path assets = folder.path() / "assets";
  ASSERT_EQ(
      RunProgram("library --kind mug --count 2 --no-check -o " + (assets / "mugs").string()).code,
      0);
  const Outcome good = RunProgram("check " + assets.string());
  EXPECT_EQ(good.code, 0) << good.text;
  EXPECT_NE(good.text.find("mugs/mug_1"), std::string::npos) << good.text;
  EXPECT_NE(good.text.find("2 of 2 pass"), std::string::npos) << good.text;

  std::ofstream(assets / "mugs/mug_2/mug_2.urdf") << "<robot";
  const Outcome bad = RunProgram("check " + assets.string() + " --json", "/dev/null");
  EXPECT_EQ(bad.code, 1) << bad.text;
  const auto json = nlohmann::json::parse(bad.text);
  EXPECT_EQ(json["passed"], false);
  ASSERT_EQ(json["reports"].size(), 2u);
  EXPECT_EQ(json["reports"][0]["passed"], true);
  EXPECT_EQ(json["reports"][1]["passed"], false);
  EXPECT_FALSE(json["findings"].empty());

  fs::create_directories(folder.path() / "none");
  const Outcome none = RunProgram("check " + (folder.path() / "none").string());
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.text.find("has no asset.json"), std::string::npos) << none.text;
}

}  // namespace
}  // namespace simwright
