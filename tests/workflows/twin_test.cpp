#include "workflows/twin/twin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "core/error.h"
#include "core/files.h"
#include "tests/twin/rendered_table.h"
#include "workflows/scenes/scene_source.h"
#include "workflows/twin/twin_detections.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

TwinRecord SmallRecord() {
  TwinRecord record;
  record.photo = "table.jpg";
  record.camera = twin::TableCamera{0.6, 0.02, 1.1, 0.7}.At(320, 240);
  record.log_scale_error = 0.05;
  record.stands = true;
  record.penetration = 1e-5;
  TwinObject object;
  object.name = "mug_1";
  object.source = TwinSource::kLifted;
  object.kind = "mug";
  object.joints = {{"lid", 1.25}};
  object.category = "mug";
  object.world_from_object.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  object.world_from_object.translation() = Eigen::Vector3d(0.1, 0.9, 1e-4);
  object.size = {0.12, 0.08, 0.1};
  object.confidence = 0.7;
  object.outline_iou = 0.93;
  object.position_error = 0.004;
  object.yaw_error = 0.05;
  object.size_error = 0.06;
  object.settled = 2e-4;
  object.box = {Eigen::Vector2d(10, 20), Eigen::Vector2d(60, 70)};
  record.objects.push_back(object);
  return record;
}

TEST(TwinRecord, IsReadAsWritten) {
  const core::TemporaryFolder folder;
  const TwinRecord record = SmallRecord();
  core::WriteFile(folder.path() / "twin.json", TwinJson(record));
  const TwinRecord read = ReadTwin(folder.path());
  ASSERT_EQ(read.objects.size(), 1u);
  EXPECT_EQ(read.objects[0].size, record.objects[0].size);
  EXPECT_EQ(read.objects[0].source, TwinSource::kLifted);
  EXPECT_EQ(read.objects[0].joints, record.objects[0].joints);
  EXPECT_EQ(read.objects[0].position_error, record.objects[0].position_error);
  EXPECT_EQ(read.objects[0].box.max(), record.objects[0].box.max());
  EXPECT_EQ(read.log_scale_error, record.log_scale_error);
  EXPECT_TRUE(read.stands);
  EXPECT_TRUE(read.objects[0].world_from_object.isApprox(record.objects[0].world_from_object));
  EXPECT_TRUE(read.camera.world_from_camera.isApprox(record.camera.world_from_camera));
}

TEST(TwinRecord, NamesWhatIsDamaged) {
  const core::TemporaryFolder folder;
  EXPECT_THROW(ReadTwin(folder.path()), core::Error);
  const std::string text = TwinJson(SmallRecord());
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const size_t at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    changed.replace(at, from.size(), to);
    core::WriteFile(folder.path() / "twin.json", changed);
    try {
      ReadTwin(folder.path());
    } catch (const core::Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal("\"confidence\": 0.7", "\"confidence\": 7").find("confidence"),
            std::string::npos);
  EXPECT_NE(refusal("assets/mug_1", "../mug_1").find("asset"), std::string::npos);
  EXPECT_NE(refusal("\"twin_format\": 1", "\"twin_format\": 2").find("twin_format"),
            std::string::npos);
  EXPECT_NE(refusal("0.12", "1e400").size(), 0u);
  EXPECT_NE(refusal("\"lifted\"", "\"stolen\"").find("source"), std::string::npos);
  EXPECT_NE(refusal("1.25", "\"open\"").find("joints"), std::string::npos);
}

TEST(ReadTwinObjects, TakesBoxesCategoriesAndMasks) {
  const core::TemporaryFolder folder;
  core::Image photo(100, 80, 3, 200);
  for (int y = 30; y < 60; ++y) {
    for (int x = 20; x < 50; ++x) {
      std::uint8_t* pixel = photo.At(x, y);
      pixel[0] = 180;
      pixel[1] = 30;
      pixel[2] = 30;
    }
  }
  core::Image mask(100, 80, 1);
  for (int y = 5; y < 20; ++y) {
    for (int x = 60; x < 90; ++x) *mask.At(x, y) = 255;
  }
  core::WritePng(folder.path() / "mask.png", mask);
  const fs::path file = folder.path() / "objects.json";
  // The photo's file has twice the size of the photo as used.
  core::WriteFile(file, R"({"objects": [
    {"box": [34, 54, 106, 126], "category": "mug"},
    {"box": [120, 10, 180, 40], "mask": "mask.png"}]})");
  const TwinDetections read = ReadTwinObjects(file, photo, 200, 160);
  ASSERT_EQ(read.found.objects.size(), 2u);
  const Eigen::AlignedBox2d& box = read.found.objects[0].box;
  EXPECT_NEAR(box.min().x(), 20.0, 1.0);
  EXPECT_NEAR(box.min().y(), 30.0, 1.0);
  EXPECT_NEAR(box.max().x(), 50.0, 1.0);
  EXPECT_NEAR(box.max().y(), 60.0, 1.0);
  ASSERT_EQ(read.kinds[0].size(), 1u);
  EXPECT_EQ(library_fit::FitKinds()[static_cast<size_t>(read.kinds[0][0])].name, "mug");
  EXPECT_TRUE(read.kinds[1].empty());
  EXPECT_EQ(read.found.objects[1].box.min().x(), 60.0);
  for (const char* bad :
       {R"({"objects": [{"box": [50, 5, 40, 20]}]})", R"({"objects": [{"box": [1, 2, 3]}]})",
        R"({"objects": [{"box": [500, 5, 600, 20]}]})",
        R"({"objects": [{"box": [1, 2, 50, 60], "category": "zzyx"}]})",
        R"({"objects": [{"box": [1, 2, 50, 60], "mask": "../mask.png"}]})",
        R"({"objects": [{"box": [1, 2, 3, 60]}]})", R"({"objects": [{"bax": [1, 2, 50, 60]}]})",
        R"({"things": []})", "{"}) {
    core::WriteFile(file, bad);
    EXPECT_THROW(ReadTwinObjects(file, photo, 200, 160), core::Error) << bad;
  }
}

TEST(LimitDetections, KeepsTheLargestWithTheirKinds) {
  TwinDetections detections;
  for (const double side : {5.0, 50.0, 20.0}) {
    twin::Detection detection;
    detection.box = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(side)};
    detections.found.objects.push_back(detection);
    detections.kinds.push_back({static_cast<int>(side)});
  }
  core::Findings findings;
  LimitDetections(2, &detections, &findings);
  EXPECT_EQ(detections.kinds, (std::vector<std::vector<int>>{{50}, {20}}));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "twin-many-objects");
  LimitDetections(2, &detections, &findings);
  EXPECT_EQ(findings.size(), 1u);
}

TEST(LimitDetections, KeepsTwentyFiveOfForty) {
  TwinDetections detections;
  for (int k = 0; k < 40; ++k) {
    twin::Detection detection;
    detection.box = {Eigen::Vector2d::Zero(), Eigen::Vector2d(10.0 + k, 10.0)};
    detections.found.objects.push_back(detection);
  }
  core::Findings findings;
  LimitDetections(TwinRequest().most_objects, &detections, &findings);
  EXPECT_EQ(detections.found.objects.size(), 25u);
  EXPECT_EQ(detections.found.objects.front().box.max().x(), 25.0);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "twin-many-objects");
  EXPECT_EQ(findings[0].figure, 40.0);
}

// The whole way, with a known camera and the objects' masks: a scene that stands, in metres, that
// the scene commands read.
TEST(MakeTwin, RebuildsAPhotoInMetres) {
  const twin::TableCamera camera{0.65, 0.0, 1.1, 0.7};
  const twin::RenderedTable table = twin::RenderKinds(
      {{"apple", 1'000'000'011, -0.1, 0.85, 0.0}, {"cereal_box", 1'000'000'012, 0.1, 1.0, 0.5}},
      camera);
  const core::TemporaryFolder folder;
  core::WritePng(folder.path() / "photo.png", table.picture.color);
  std::string objects;
  for (size_t k = 0; k < 2; ++k) {
    const std::string mask = "mask" + std::to_string(k) + ".png";
    core::WritePng(folder.path() / mask, table.detections[k].alpha);
    objects += std::string(k > 0 ? "," : "") + R"({"box": [0, 0, 320, 240], "category": ")" +
               (k == 0 ? "apple" : "cereal box") + R"(", "mask": ")" + mask + "\"}";
  }
  core::WriteFile(folder.path() / "objects.json", "{\"objects\": [" + objects + "]}");
  TwinRequest request;
  request.photo = folder.path() / "photo.png";
  request.objects = folder.path() / "objects.json";
  request.camera.fov = 2.0 * std::atan(0.5 / camera.focal) * 180.0 / M_PI;
  request.camera.elevation = camera.elevation * 180.0 / M_PI;
  request.camera.height = camera.height;
  request.camera.upright = true;
  request.output = folder.path() / "twin";
  core::Progress progress;
  const TwinOutcome outcome = MakeTwin(request, &progress);
  ASSERT_EQ(outcome.record.objects.size(), 2u);
  EXPECT_TRUE(outcome.record.stands);
  EXPECT_LT(outcome.record.penetration, 1e-4);
  const TwinRecord read = ReadTwin(outcome.folder);
  EXPECT_EQ(read.objects[0].name, "apple_1");
  const Eigen::Vector3d apple = read.objects[0].world_from_object.translation();
  EXPECT_NEAR(apple.x(), -0.1, 0.02);
  EXPECT_NEAR(apple.y(), 0.85, 0.02);
  EXPECT_NEAR(apple.z(), 0.0, 0.005);
  EXPECT_GT(read.objects[0].position_error, 0.0);
  for (const char* file : {"photo.png", "twin.png", "overlay.png", "above.png", "index.html",
                           "assets/apple_1/apple_1.urdf", "assets/cereal_box_1/asset.json"}) {
    EXPECT_TRUE(fs::exists(outcome.folder / file)) << file;
  }
  const SceneSource source = ReadSceneSource(outcome.folder / "twin.json", "", "");
  ASSERT_EQ(source.scenes.size(), 1u);
  EXPECT_EQ(source.scenes[0].objects.size(), 2u);
  // The output is kept unless it is to be replaced.
  EXPECT_THROW(MakeTwin(request, &progress), core::Error);
  // A detector beside boxes has nothing to do.
  request.output = folder.path() / "other";
  request.detector = fs::path(SIMWRIGHT_SOURCE_DIR) / "models/table_detector.pt";
  EXPECT_THROW(MakeTwin(request, &progress), core::Error);
}

TEST(MakeTwin, RefusesPhotosWithoutATable) {
  const core::TemporaryFolder folder;
  core::WritePng(folder.path() / "small.png", core::Image(20, 20, 3));
  TwinRequest request;
  request.photo = folder.path() / "small.png";
  request.output = folder.path() / "twin";
  core::Progress progress;
  EXPECT_THROW(MakeTwin(request, &progress), core::Error);
  request.photo = folder.path() / "none.png";
  EXPECT_THROW(MakeTwin(request, &progress), core::Error);
  request.camera.elevation = 95.0;
  try {
    MakeTwin(request, &progress);
    ADD_FAILURE() << "an impossible camera was taken";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("elevation"), std::string::npos) << error.what();
  }
  EXPECT_FALSE(fs::exists(request.output));
}

}  // namespace
}  // namespace simwright::workflows
