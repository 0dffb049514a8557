// `simwright scene export` and `scene view`: steamers on the library's round table, stacked by
// hand, as world files; moving objects are detected; bad input is rejected before anything is
// written.
#include "workflows/scenes/scene_export.h"

#include <gtest/gtest.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "assets/asset_folder.h"
#include "assets/urdf_reader.h"
#include "core/error.h"
#include "core/files.h"
#include "program.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "workflows/library/library.h"
#include "workflows/scenes/dataset_scenes.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;
using Eigen::Isometry3d;

const std::vector<std::string> kSlots = {"steamer", "steamer_lid", "table_round"};

class SceneExport : public testing::Test {
 protected:
  // One test runs all checks, because separate processes would each make all assets again.
  static void StacksStandStillInBothEnginesAndWhatHangsFalls();
  static void IsSelfContained();
  static void RefusesWhatIsNone();
  static void SaysWhichAssetIsMissingOrAnother();
  static void IsACommand();
  static void AViewShowsTheTableRoundFromAbove();

  static void SetUpTestSuite() {
    folder_ = new core::TemporaryFolder();
    LibraryOptions options;
    options.kind = "steamer,steamer_lid,table_round";
    options.check = false;
    core::Progress silent;
    const auto made = MakeLibrary(options, At("made"), &silent);
    fs::create_directories(At("dataset/assets"));
    for (size_t i = 0; i < made.size(); ++i) {
      fs::rename(made[i].folder, At("dataset/assets/" + kSlots[i]));
      heights_.push_back(
          core::Bounds(assets::ReadAsset(At("dataset/assets/" + kSlots[i])).solid).max().z());
    }
    WriteScenes({Stack(4, 0.0), Stack(1, 0.0), Stack(1, 0.05)}, "{}", At("dataset"));
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string At(const std::string& name) { return (folder_->path() / name).string(); }

  // Steamers on the table, each rotated differently, with a lid on top, all `above` (m) their
  // support.
  static std::vector<scene::SceneObject> Stack(int count, double above) {
    std::vector<scene::SceneObject> objects = {
        {"table_round", "table", Isometry3d::Identity(), true, -1}};
    for (int i = 0; i <= count; ++i) {
      Isometry3d pose(Eigen::Translation3d(0.2, 0.1, heights_[2] + above + i * heights_[0]));
      pose.rotate(Eigen::AngleAxisd(2.4 * i, Eigen::Vector3d::UnitZ()));
      const std::string slot = i < count ? "steamer" : "steamer_lid";
      objects.push_back({slot, slot, pose, false, i});
    }
    return objects;
  }

  static void WriteScenes(const std::vector<std::vector<scene::SceneObject>>& scenes,
                          const std::string& assets, const fs::path& folder) {
    const scene::Vocabulary vocabulary{"stacks", 6, kSlots, {false, false, true}};
    scene::SceneShard part{vocabulary, {1, 0, assets, "{}", "1"}, {}, {}};
    const auto size = static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth());
    for (const auto& objects : scenes) {
      part.tokens.resize(part.tokens.size() + size);
      EncodeScene(objects, vocabulary, &part.tokens[part.tokens.size() - size]);
      const int count = static_cast<int>(objects.size());
      part.attempts.push_back({count, count, 0, true, true, 0.0, 0.0, 0.0});
    }
    fs::create_directories(folder);
    WriteShard(part, folder / scene::ShardName(0));
  }

  static SceneExportRequest Request(const std::string& output) {
    SceneExportRequest request;
    request.dataset = At("dataset");
    request.formats = {"all"};
    request.output = At(output);
    return request;
  }

  static std::string ErrorOf(const SceneExportRequest& request) {
    core::Progress silent;
    try {
      ExportScenes(request, &silent);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  }

  static inline core::TemporaryFolder* folder_ = nullptr;
  static inline std::vector<double> heights_;
};

void SceneExport::StacksStandStillInBothEnginesAndWhatHangsFalls() {
  SceneExportRequest request = Request("checked");
  request.check = true;
  core::Progress silent;
  const SceneExportReport report = ExportScenes(request, &silent);
  ASSERT_EQ(report.checks.size(), 3u);
  for (int i = 0; i < 2; ++i) {
    const SceneStability& check = report.checks[static_cast<size_t>(i)];
    EXPECT_TRUE(check.Still()) << ExportTable(report);
    EXPECT_TRUE(check.warnings.empty()) << check.warnings[0];
    EXPECT_EQ(check.objects, i == 0 ? 5 : 2);
    EXPECT_GT(check.mujoco.moved, 0.0);
  }
  // Dropped by 5 cm.
  EXPECT_FALSE(report.checks[2].StableInMujoco());
  EXPECT_FALSE(report.checks[2].StableInBullet());
  EXPECT_GT(report.checks[2].mujoco.moved, 0.045);
  EXPECT_GT(report.checks[2].bullet.moved, 0.045);
  EXPECT_NEAR(report.StableFraction(), 2.0 / 3.0, 1e-12);
  const auto json = nlohmann::json::parse(core::ReadFile(At("checked/stillness.json")));
  EXPECT_EQ(json["checks"][2]["still"], false);
}

void SceneExport::IsSelfContained() {
  core::Progress silent;
  SceneExportRequest request = Request("before");
  request.scenes = "1,0";
  ExportScenes(request, &silent);
  fs::rename(At("before"), At("moved"));
  for (const char* const name :
       {"scene.json", "world.sdf", "gazebo.sdf", "scene.xml", "scene.dmd.yaml", "scene.usda"}) {
    EXPECT_TRUE(fs::exists(At("moved/scene_00001/") + name)) << name;
    const std::string text = core::ReadFile(At("moved/scene_00001/") + name);
    EXPECT_EQ(text.find(folder_->path().string()), std::string::npos) << name;
  }
  const auto json = nlohmann::json::parse(core::ReadFile(At("moved/scene_00001/scene.json")));
  ASSERT_EQ(json["objects"].size(), 3u);
  for (const auto& object : json["objects"]) {
    const auto model =
        assets::ReadUrdf(fs::path(At("moved/scene_00001")) / object["urdf"].get<std::string>());
    EXPECT_TRUE(model.findings.empty());
    const assets::Asset asset =
        assets::ReadAsset(At("dataset/assets/" + object["slot"].get<std::string>()));
    EXPECT_NEAR(model.links[0].inertial->mass, asset.inertial.mass, 1e-12);
    EXPECT_EQ(model.links[0].collisions.size(), asset.parts.size());
    const std::string slot = object["slot"];
    EXPECT_TRUE(fs::exists(At("moved/assets/" + slot) + "/" + slot + ".usda")) << slot;
  }
  const std::vector<scene::SceneObject> objects =
      SceneAt(scene::SceneDataset(fs::path(At("dataset"))), 1);
  for (size_t i = 0; i < objects.size(); ++i) {
    EXPECT_EQ(json["objects"][i]["translation"][2].get<double>(),
              objects[i].world_from_object.translation().z());
  }
  const sim::MujocoStability watched =
      sim::CheckStabilityInMujoco(At("moved/scene_00001/scene.xml"), {0.0, 0.01});
  EXPECT_EQ(watched.bodies.size(), 2u);
  EXPECT_TRUE(watched.warnings.empty());
}

void SceneExport::RefusesWhatIsNone() {
  SceneExportRequest request = Request("refused");
  for (const char* const scenes : {"3", "0-3", "0,7", "99999999999", "a", "-1", "2-1", ",", "1-"}) {
    request.scenes = scenes;
    EXPECT_NE(ErrorOf(request), "") << scenes;
  }
  request.scenes = "3";
  EXPECT_NE(ErrorOf(request).find("0 to 2"), std::string::npos) << ErrorOf(request);
  request = Request("refused");
  request.count = 4;
  EXPECT_NE(ErrorOf(request).find("3 scenes"), std::string::npos);
  request = Request("refused");
  request.formats = {"stl"};
  EXPECT_NE(ErrorOf(request).find("stl"), std::string::npos);
  request = Request("refused");
  request.assets = At("nowhere");
  EXPECT_NE(ErrorOf(request).find("no folder of assets"), std::string::npos);
  EXPECT_FALSE(fs::exists(At("refused")));
  EXPECT_EQ(ParseSceneIndices("2,0-1,1", 3), (std::vector<int>{2, 0, 1}));
}

void SceneExport::SaysWhichAssetIsMissingOrAnother() {
  fs::create_directories(At("few"));
  for (const char* const slot : {"steamer", "table_round"}) {
    fs::copy(At("dataset/assets/") + slot, At("few/") + slot, fs::copy_options::recursive);
  }
  SceneExportRequest request = Request("refused");
  request.assets = At("few");
  EXPECT_NE(ErrorOf(request).find("\"steamer_lid\""), std::string::npos) << ErrorOf(request);
  fs::copy(At("few/steamer"), At("few/steamer_lid"), fs::copy_options::recursive);
  EXPECT_EQ(ErrorOf(request), "");  // these scenes do not record their assets
  // The scenes were made with another lid.
  const scene::AssetSet asset_set =
      scene::ReadAssetSet(FoldersOfCategories(At("dataset"), "", {kSlots.begin(), kSlots.end()}));
  const nlohmann::json hashes = {{"steamer", asset_set.HashOf("steamer")},
                                 {"steamer_lid", asset_set.HashOf("steamer_lid")}};
  WriteScenes({Stack(1, 0.0)}, hashes.dump(), At("hashed"));
  request = Request("refused_too");
  request.dataset = At("hashed");
  request.assets = At("few");
  EXPECT_NE(ErrorOf(request).find("\"steamer_lid\""), std::string::npos) << ErrorOf(request);
  EXPECT_FALSE(fs::exists(At("refused_too")));
  request.assets = At("dataset/assets");
  EXPECT_EQ(ErrorOf(request), "");
}

void SceneExport::IsACommand() {
  const std::string command = "scene export " + At("dataset") + " --quiet -o " + At("told");
  const Outcome written = RunProgram(command + " --scene 1 --format mjcf,urdf --check");
  EXPECT_EQ(written.code, 0) << written.text;
  EXPECT_NE(written.text.find("1 of 1 scenes"), std::string::npos) << written.text;
  EXPECT_FALSE(fs::exists(At("told/scene_00001/world.sdf")));
  EXPECT_EQ(RunProgram(command + " --count 1").code, 1);
  EXPECT_EQ(RunProgram(command + " --count 1 --force").code, 0);
  EXPECT_FALSE(fs::exists(At("told/scene_00001")));
  EXPECT_EQ(RunProgram(command + " --count 1 --scene 0 --force").code, 2);
  const Outcome moves = RunProgram(command + " --scene 2 --force --check");
  EXPECT_EQ(moves.code, 1);
  EXPECT_NE(moves.text.find("MOVES"), std::string::npos) << moves.text;
}

void SceneExport::AViewShowsTheTableRoundFromAbove() {
  const std::string command = "scene view " + At("dataset") + " --size 200 --scene 0 -o ";
  ASSERT_EQ(RunProgram(command + At("view.png")).code, 0);
  const core::Image picture = core::ReadImage(At("view.png"));
  ASSERT_EQ(picture.width, 400);
  ASSERT_EQ(picture.height, 200);
  // The left half: a disc, as wide as high, not cut by any edge.
  int left = 200, right = 0, top = 200, bottom = 0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      const std::uint8_t* const p = picture.At(x, y);
      if (p[0] > 250 && p[1] > 250 && p[2] > 250) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  EXPECT_GT(left, 0);
  EXPECT_LT(bottom, 199);
  EXPECT_GT(right - left, 140);
  EXPECT_NEAR(right - left, bottom - top, 3);
  EXPECT_EQ(RunProgram(command + At("view.png")).code, 1);
  EXPECT_EQ(RunProgram("scene view " + At("dataset") + " --scene 3 -o " + At("no.png")).code, 1);
  EXPECT_FALSE(fs::exists(At("no.png")));
}

TEST_F(SceneExport, DoesAllOfIt) {
  {
    SCOPED_TRACE("StacksStandStillInBothEnginesAndWhatHangsFalls");
    StacksStandStillInBothEnginesAndWhatHangsFalls();
  }
  {
    SCOPED_TRACE("IsSelfContained");
    IsSelfContained();
  }
  {
    SCOPED_TRACE("RefusesWhatIsNone");
    RefusesWhatIsNone();
  }
  {
    SCOPED_TRACE("SaysWhichAssetIsMissingOrAnother");
    SaysWhichAssetIsMissingOrAnother();
  }
  {
    SCOPED_TRACE("IsACommand");
    IsACommand();
  }
  {
    SCOPED_TRACE("AViewShowsTheTableRoundFromAbove");
    AViewShowsTheTableRoundFromAbove();
  }
}

}  // namespace
}  // namespace simwright::workflows
