// Findings of scenes about dropped objects and unused assets.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "workflows/scenes/scene_assets.h"
#include "workflows/scenes/scene_generation.h"

namespace simwright::workflows {
namespace {

scene::SceneAttempt Attempt(int kept, int dropped) {
  scene::SceneAttempt attempt;
  attempt.sampled = kept + dropped;
  attempt.kept = kept;
  attempt.dropped = dropped;
  attempt.projected = attempt.valid = true;
  return attempt;
}

TEST(SceneFindings, TheShareOfObjectsThatWasKeptIsSaid) {
  const SceneStatistics third = StatisticsOf({Attempt(6, 4), Attempt(8, 3)});
  EXPECT_DOUBLE_EQ(third.yield, 1.0);
  EXPECT_NEAR(third.kept, 14.0 / 21.0, 1e-12);
  const core::Findings findings = DroppedFindings(third);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "objects-dropped");
  EXPECT_EQ(findings[0].severity, core::Severity::kWarning);
  EXPECT_NEAR(findings[0].figure, 1.0 / 3.0, 1e-12);
  EXPECT_NE(findings[0].sentence.find("33 % of the objects"), std::string::npos);
  EXPECT_NE(StatisticsTable(third).find("66.7 % of their objects kept"), std::string::npos);
  EXPECT_NEAR(nlohmann::json::parse(StatisticsJson(third))["kept_share"].get<double>(), 14.0 / 21.0,
              1e-9);
  EXPECT_TRUE(DroppedFindings(StatisticsOf({Attempt(20, 1)})).empty());
}

TEST(SceneFindings, FiguresOfPhysicsAreLeftOutWithoutPhysics) {
  SceneStatistics raw = StatisticsOf({Attempt(6, 0), Attempt(8, 0)});
  raw.physics = false;
  const std::string table = StatisticsTable(raw);
  EXPECT_NE(table.find("without physics"), std::string::npos) << table;
  EXPECT_NE(table.find("objects: mean 7.0, at most 8"), std::string::npos) << table;
  for (const char* const measured : {"penetration", "drift", "objects kept"}) {
    EXPECT_EQ(table.find(measured), std::string::npos) << table;
  }
}

TEST(SceneFindings, AFolderOfWhichNothingIsTakenIsSaid) {
  const core::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "mine/empty");
  core::Findings findings;
  core::Progress progress;
  GatherSceneAssets({{}, {}, {folder.path() / "mine"}, folder.path() / "kept", &findings},
                    &progress);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "assets-unused");
  EXPECT_NE(findings[0].sentence.find("has no asset folders"), std::string::npos);
  EXPECT_NE(findings[0].remedy.find("--asset SLOT=FOLDER"), std::string::npos);
}

}  // namespace
}  // namespace simwright::workflows
