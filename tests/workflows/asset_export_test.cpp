// `simwright export ASSET --format usd`: the files and the report. tests/usd judges the layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "assets/asset_folder.h"
#include "assets/mesh_import.h"
#include "core/files.h"
#include "program.h"
#include "tests/assets/sample_asset.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

TEST(AssetExport, WritesALayerThatItsReportDescribes) {
  const core::TemporaryFolder folder;
  const assets::Asset asset = assets::SampleAsset();
  fs::create_directories(folder.path() / "asset");
  assets::WriteAsset(asset, folder.path() / "asset");
  const Outcome made = RunProgram("export " + (folder.path() / "asset").string() +
                                  " --format usd --json -o " + (folder.path() / "usd").string());
  ASSERT_EQ(made.code, 0) << made.text;
  const auto report = nlohmann::json::parse(made.text);
  EXPECT_EQ(report["bodies"], 1);
  EXPECT_EQ(report["joints"], 0);
  EXPECT_EQ(report["convex_parts"], asset.parts.size());
  EXPECT_NEAR(report["mass_kg"], asset.inertial.mass, 1e-9);
  const std::string text =
      core::ReadFile(folder.path() / "usd" / report["file"].get<std::string>());
  EXPECT_TRUE(text.starts_with("#usda 1.0"));
  // A second export needs --force.
  const Outcome again = RunProgram("export " + (folder.path() / "asset").string() +
                                   " --format usd -o " + (folder.path() / "usd").string());
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.text.find("--force"), std::string::npos) << again.text;
}

TEST(AssetExport, WritesAGlbThatTheImporterReads) {
  const core::TemporaryFolder folder;
  const assets::Asset asset = assets::SampleAsset();
  fs::create_directories(folder.path() / "asset");
  assets::WriteAsset(asset, folder.path() / "asset");
  const std::string command = "export " + (folder.path() / "asset").string() + " --format glb -o ";
  const fs::path file = folder.path() / "out.glb";
  const Outcome made = RunProgram(command + file.string());
  ASSERT_EQ(made.code, 0) << made.text;
  const assets::MeshFile read = assets::ReadMeshFile(file);
  EXPECT_EQ(read.mesh.mesh.triangles.size(), asset.visual.mesh.triangles.size());
  EXPECT_NEAR(core::SurfaceArea(read.mesh.mesh), core::SurfaceArea(asset.visual.mesh), 1e-6);
  const Outcome again = RunProgram(command + file.string());
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.text.find("--force"), std::string::npos) << again.text;
  const Outcome named = RunProgram(command + (folder.path() / "out.gltf").string());
  EXPECT_EQ(named.code, 1);
  EXPECT_NE(named.text.find(".glb"), std::string::npos) << named.text;
}

TEST(AssetExport, RefusesWhatIsNoAssetInOneLine) {
  const core::TemporaryFolder folder;
  const Outcome refused = RunProgram("export " + folder.path().string() + " --format usd -o " +
                                     (folder.path() / "usd").string());
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.text.find("asset.json"), std::string::npos) << refused.text;
  EXPECT_EQ(std::count(refused.text.begin(), refused.text.end(), '\n'), 1) << refused.text;
  EXPECT_FALSE(fs::exists(folder.path() / "usd"));
}

}  // namespace
}  // namespace simwright::workflows
