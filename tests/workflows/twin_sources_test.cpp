// The sources of a twin beside boxes: depth, a calibration, a vision model, the user's assets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "asset_build/asset_builder.h"
#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "core/image.h"
#include "library_fit/fitted_object.h"
#include "llm/make_chat_model.h"
#include "physics_params/category_resolution.h"
#include "program.h"
#include "tests/llm/chat_server.h"  // last: see there
#include "tests/twin/depth_pictures.h"
#include "workflows/twin/twin.h"
#include "workflows/twin/twin_objects.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

const twin::TableCamera kEye{0.65, 0.0, 1.1, 0.7};

twin::RenderedTable AppleAndBox() {
  return twin::RenderKinds(
      {{"apple", 1'000'000'011, -0.1, 0.85, 0.0}, {"cereal_box", 1'000'000'012, 0.1, 1.0, 0.5}},
      kEye);
}

bool Has(const core::Findings& findings, const std::string& code) {
  return std::any_of(findings.begin(), findings.end(),
                     [&](const core::Finding& finding) { return finding.code == code; });
}

class TwinSources : public ::testing::Test {
 protected:
  fs::path Path(const std::string& name) const { return folder_.path() / name; }

  TwinRequest RequestFor(const core::Image& photo) {
    core::WritePng(Path("photo.png"), photo);
    TwinRequest request;
    request.photo = Path("photo.png");
    request.detector = "";
    request.output = Path("twin");
    return request;
  }

  void StateCamera(TwinRequest* request) {
    request->camera.fov = 2.0 * std::atan(0.5 / kEye.focal) * 180.0 / M_PI;
    request->camera.elevation = kEye.elevation * 180.0 / M_PI;
    request->camera.height = kEye.height;
    request->camera.upright = true;
  }

  // Requests a twin of one object before kEye, known by its mask and `category`, if any.
  TwinRequest RequestForOne(const twin::TableObject& object, const std::string& category) {
    twin::RenderedTable table;
    table.scene.objects.push_back(object);
    table.scene.table.endless = true;
    twin::Picture(kEye, &table);
    TwinRequest request = RequestFor(table.picture.color);
    StateCamera(&request);
    request.objects = Path("objects.json");
    core::WritePng(Path("mask.png"), table.detections[0].alpha);
    core::WriteFile(request.objects,
                    R"({"objects": [{"box": [0, 0, 320, 240], "mask": "mask.png")" +
                        (category.empty() ? "" : R"(, "category": ")" + category + '"') + "}]}");
    return request;
  }

  std::string Refusal(const TwinRequest& request) {
    core::Progress progress;
    try {
      MakeTwin(request, &progress);
    } catch (const core::Error& error) {
      EXPECT_FALSE(fs::exists(request.output));
      return error.what();
    }
    return "";
  }

  core::TemporaryFolder folder_;
};

// Depth and a calibration alone: the camera, the scale and the objects.
TEST_F(TwinSources, DepthGivesTheTableAndItsObjects) {
  const twin::RenderedTable table = AppleAndBox();
  TwinRequest request = RequestFor(table.picture.color);
  request.depth = Path("depth.png");
  twin::WriteDepth(request.depth, twin::DepthOf(table));
  request.intrinsics = Path("camera.json");
  core::WriteFile(request.intrinsics,
                  R"({"fx": 704, "fy": 704, "cx": 320, "cy": 240, "width": 640, "height": 480})");
  core::Progress progress;
  const TwinOutcome outcome = MakeTwin(request, &progress);
  EXPECT_FALSE(Has(outcome.findings, "twin-scale-guessed"));
  EXPECT_FALSE(Has(outcome.findings, "twin-depth-disagrees"));
  EXPECT_NEAR(outcome.record.camera.position().z() / kEye.height, 1.0, 0.01);
  EXPECT_EQ(outcome.record.log_scale_error, 0.0);
  ASSERT_EQ(outcome.record.objects.size(), 2u);
  for (const twin::TableObject& truth : table.scene.objects) {
    const Eigen::Vector2d at = truth.world_from_object.translation().head<2>();
    double nearest = 1.0;
    for (const TwinObject& object : outcome.record.objects) {
      nearest = std::min(nearest, (object.world_from_object.translation().head<2>() - at).norm());
    }
    EXPECT_LT(nearest, 0.03);
  }
}

TEST_F(TwinSources, WallsDarknessAndForeignDepthAreRefused) {
  const twin::RenderedTable table = AppleAndBox();
  TwinRequest request = RequestFor(table.picture.color);
  request.depth = Path("depth.png");
  request.camera.fov = 49.0;
  twin::WriteDepth(request.depth, twin::DepthOfPlane(table.scene.camera, {0.1, 0.0, 1.0}, 1.5));
  EXPECT_NE(Refusal(request).find("the depth shows no table"), std::string::npos);
  core::WritePng(request.depth, core::Image(320, 240, 1, 100));
  EXPECT_NE(Refusal(request).find("16 bits"), std::string::npos);
  twin::WriteDepth(request.depth, core::FloatImage(320, 240, 1));
  EXPECT_NE(Refusal(request).find("all are 0"), std::string::npos);
  twin::WriteDepth(request.depth, core::FloatImage(240, 320, 1, 1.0f));
  EXPECT_NE(Refusal(request).find("another aspect"), std::string::npos);
  request.camera.height = 0.7;
  EXPECT_NE(Refusal(request).find("leave out"), std::string::npos);
  // A table on which nothing stands.
  request.camera.height = 0.0;
  twin::WriteDepth(request.depth, twin::DepthOf(twin::RenderKinds({}, kEye)));
  EXPECT_NE(Refusal(request).find("no object on a table"), std::string::npos);
  // The night.
  core::Image dark = table.picture.color;
  for (std::uint8_t& value : dark.pixels) value = static_cast<std::uint8_t>(value / 30);
  core::WritePng(request.photo, dark);
  EXPECT_NE(Refusal(request).find("too dark"), std::string::npos);
}

// The same table from two sides, with depth: the objects of both photos in one frame.
TEST_F(TwinSources, TwoPhotosAreMerged) {
  const twin::RenderedTable front = AppleAndBox();
  // The second camera stands at (0.9, 0.3) and looks towards the objects: its frame is turned.
  const double turn = 0.9;
  const Eigen::Vector2d stand(0.75, 0.25);
  twin::RenderedTable side;
  for (const twin::TableObject& object : front.scene.objects) {
    twin::TableObject moved = object;
    Eigen::Isometry3d side_from_front = Eigen::Isometry3d::Identity();
    side_from_front.linear() =
        Eigen::AngleAxisd(-turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    side_from_front.translation().head<2>() = -(Eigen::Rotation2Dd(-turn) * stand);
    moved.world_from_object = side_from_front * object.world_from_object;
    side.scene.objects.push_back(moved);
  }
  side.scene.table.endless = true;
  twin::Picture(kEye, &side);
  TwinRequest request = RequestFor(front.picture.color);
  request.camera.fov = 2.0 * std::atan(0.5 / kEye.focal) * 180.0 / M_PI;
  request.depth = Path("depth.png");
  twin::WriteDepth(request.depth, twin::DepthOf(front));
  TwinView second;
  second.photo = Path("side.png");
  second.depth = Path("side_depth.png");
  core::WritePng(second.photo, side.picture.color);
  twin::WriteDepth(second.depth, twin::DepthOf(side));
  request.more.push_back(second);
  core::Progress progress;
  const TwinOutcome outcome = MakeTwin(request, &progress);
  const TwinRecord read = ReadTwin(outcome.folder);
  ASSERT_EQ(read.objects.size(), 2u);
  for (const twin::TableObject& truth : front.scene.objects) {
    const Eigen::Vector2d at = truth.world_from_object.translation().head<2>();
    double nearest = 1.0;
    for (const TwinObject& object : read.objects) {
      nearest = std::min(nearest, (object.world_from_object.translation().head<2>() - at).norm());
    }
    EXPECT_LT(nearest, 0.03);
  }
  for (const TwinObject& object : read.objects) {
    EXPECT_EQ(object.seen_in, (std::vector<int>{0, 1}));
  }
  request.camera.height = 0.7;
  request.force = true;
  EXPECT_THROW(MakeTwin(request, &progress), core::Error);
}

std::string BoxJson(const twin::Detection& detection) {
  std::string text = "[";
  for (const double value : {detection.box.min().x(), detection.box.min().y(),
                             detection.box.max().x(), detection.box.max().y()}) {
    text += (text.size() > 1 ? ", " : "") + std::to_string(static_cast<int>(value));
  }
  return text + "]";
}

TEST_F(TwinSources, AVisionModelNamesTheObjects) {
  const twin::RenderedTable table = AppleAndBox();
  const std::string answer =
      "{\"objects\": [{\"name\": \"apple\", \"box\": " + BoxJson(table.detections[0]) +
      "}, {\"name\": \"cereal box\", \"box\": " + BoxJson(table.detections[1]) +
      "}, {\"name\": \"table\", \"box\": [0, 60, 320, 240]}]}";
  llm::ChatServer server([&](int, const httplib::Request&, httplib::Response& response) {
    response.set_content(llm::GoodBody(answer), "application/json");
  });
  llm::ChatModelOptions options = llm::OptionsFor(server.url());
  options.cache = Path("cache");
  std::unique_ptr<llm::ChatModel> model = llm::MakeChatModel(options);
  TwinRequest request = RequestFor(table.picture.color);
  StateCamera(&request);
  request.model = model.get();
  core::Progress progress;
  const TwinOutcome outcome = MakeTwin(request, &progress);
  ASSERT_EQ(outcome.record.objects.size(), 2u);
  EXPECT_EQ(outcome.record.objects[0].kind, "apple");
  EXPECT_EQ(outcome.record.objects[1].kind, "cereal_box");
  EXPECT_NEAR(outcome.record.objects[0].world_from_object.translation().y(), 0.85, 0.03);
  EXPECT_TRUE(Has(outcome.findings, "twin-box-dropped"));
  const std::string sent = server.body(0).dump();
  EXPECT_NE(sent.find("data:image/jpeg;base64,"), std::string::npos);
  EXPECT_NE(sent.find("320 x 240"), std::string::npos);
  // The same photo again: answered from the cache.
  request.force = true;
  MakeTwin(request, &progress);
  EXPECT_EQ(server.bodies().size(), 1u);
  EXPECT_EQ(model->usage().from_cache, 1);
}

TEST_F(TwinSources, UselessAnswersOfAVisionModelAreOneError) {
  llm::ChatServer server([](int, const httplib::Request&, httplib::Response& response) {
    response.set_content(llm::GoodBody("I see a nice table."), "application/json");
  });
  std::unique_ptr<llm::ChatModel> model = llm::MakeChatModel(llm::OptionsFor(server.url()));
  TwinRequest request = RequestFor(AppleAndBox().picture.color);
  request.model = model.get();
  EXPECT_NE(Refusal(request).find("the vision model's answer cannot be used"), std::string::npos);
  EXPECT_EQ(server.bodies().size(), 2u);
  request.objects = Path("objects.json");
  EXPECT_NE(Refusal(request).find("--llm"), std::string::npos);
}

// The program: one line for an error, and the flags of a language model.
TEST_F(TwinSources, TheProgramTakesThem) {
  core::WritePng(Path("photo.png"), AppleAndBox().picture.color);
  core::WritePng(Path("depth.png"), core::Image(320, 240, 1, 100));
  const Outcome outcome =
      RunProgram("twin " + Path("photo.png").string() + " --depth " + Path("depth.png").string() +
                 " --depth-scale 0.0001 --fov 49 --quiet -o " + Path("twin").string());
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
  EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
  const std::string photo = Path("photo.png").string();
  const Outcome fewer =
      RunProgram("twin " + photo + " " + photo + " --depth " + Path("depth.png").string() +
                 " --quiet -o " + Path("twin").string());
  EXPECT_EQ(fewer.code, 1);
  EXPECT_EQ(fewer.text.rfind("error: --depth: there are 2 photos, and 1 of these files", 0), 0u)
      << fewer.text;
  const Outcome scale =
      RunProgram("twin " + photo + " --depth-scale 0.0001 --quiet -o " + Path("twin").string());
  EXPECT_EQ(scale.code, 2);
  EXPECT_EQ(scale.text.rfind("error: --depth-scale requires --depth", 0), 0u) << scale.text;
  EXPECT_EQ(std::count(scale.text.begin(), scale.text.end(), '\n'), 1) << scale.text;
  const Outcome replay = RunProgram("twin " + Path("photo.png").string() + " --replay " +
                                    Path("none.jsonl").string() + " -o " + Path("twin").string());
  EXPECT_EQ(replay.code, 1);
  EXPECT_NE(replay.text.find("none.jsonl"), std::string::npos) << replay.text;
}

// Writes an asset of the library in one colour.
void WriteColored(const char* kind, const char* category, std::uint64_t seed,
                  const Eigen::Vector4f& color, const fs::path& folder) {
  asset_build::BuildRequest request;
  request.name = folder.filename().string();
  request.source = "test";
  request.category = physics_params::RequireCategory(category);
  const library_fit::Instance instance =
      library_fit::SampleInstance(library_fit::FindFitKind(kind), seed);
  request.parts = library_fit::InstanceObject(instance).parts;
  core::TexturedMesh mesh = library_fit::InstanceMesh(instance);
  for (core::Material& material : mesh.materials) {
    material.texture = -1;
    material.base_color = color;
  }
  core::Progress progress;
  fs::create_directories(folder);
  assets::WriteAsset(asset_build::BuildAsset(mesh, request, &progress).asset, folder);
}

TEST_F(TwinSources, AnAssetOfTheUserIsFoundAgain) {
  WriteColored("cereal_box", "cereal box", 1'000'000'012, {0.8f, 0.2f, 0.15f, 1.0f},
               Path("mine/red_box"));
  WriteColored("cereal_box", "cereal box", 1'000'000'012, {0.2f, 0.35f, 0.8f, 1.0f},
               Path("mine/blue_box"));
  WriteColored("mug", "mug", 1'000'000'013, {0.2f, 0.35f, 0.8f, 1.0f}, Path("mine/blue_mug"));
  const assets::Asset asset = assets::ReadAsset(Path("mine/blue_box"));
  twin::TableObject object;
  object.visual = asset.visual;
  object.world_from_object = twin::TablePose{0.05, 0.9, 0.6}.WorldFromObject();
  TwinRequest request = RequestForOne(object, "");
  request.assets = {Path("mine")};
  core::Progress progress;
  const TwinOutcome outcome = MakeTwin(request, &progress);
  ASSERT_EQ(outcome.record.objects.size(), 1u);
  const TwinRecord read = ReadTwin(outcome.folder);
  EXPECT_EQ(read.objects[0].source, TwinSource::kRetrieved);
  EXPECT_EQ(read.objects[0].kind, "blue_box");
  EXPECT_EQ(read.objects[0].name, "blue_box_1");
  EXPECT_NEAR(read.objects[0].world_from_object.translation().x(), 0.05, 0.01);
  EXPECT_NEAR(read.objects[0].world_from_object.translation().y(), 0.9, 0.015);
  EXPECT_EQ(core::ReadFile(outcome.folder / "assets/blue_box_1/asset.json"),
            core::ReadFile(Path("mine/blue_box/asset.json")));
  const Eigen::Vector3d size = core::Bounds(asset.visual.mesh).sizes();
  EXPECT_TRUE(read.objects[0].size.isApprox(size, 1e-6));
}

// The lid of an open laptop: its angle is in the record, since the asset begins closed.
TEST_F(TwinSources, AnOpenLidIsRecorded) {
  twin::TableObject object;
  object.instance = library_fit::SampleInstance(library_fit::FindFitKind("laptop"), 1'000'000'015);
  object.instance.opening = 0.75;
  object.visual = library_fit::InstanceMesh(object.instance);
  object.world_from_object = twin::TablePose{0.0, 0.95, 0.8}.WorldFromObject();
  core::Progress progress;
  const TwinOutcome outcome = MakeTwin(RequestForOne(object, "laptop"), &progress);
  const TwinRecord read = ReadTwin(outcome.folder);
  ASSERT_EQ(read.objects.size(), 1u);
  ASSERT_EQ(read.objects[0].joints.size(), 1u);
  const assets::ArticulatedAsset truth = library_fit::InstanceAsset(object.instance);
  const auto joint = std::find_if(truth.joints.begin(), truth.joints.end(),
                                  [](const assets::Joint& one) { return one.Moves(); });
  ASSERT_NE(joint, truth.joints.end());
  EXPECT_EQ(read.objects[0].joints.begin()->first, joint->name);
  EXPECT_NEAR(read.objects[0].joints.begin()->second,
              joint->lower + 0.75 * (joint->upper - joint->lower), 0.45);
  EXPECT_TRUE(Has(outcome.findings, "twin-joint-closed"));
}

// A doubtful object as the photo shows it: of the fitted height, where the photos together place
// it.
TEST_F(TwinSources, AFreeFormTakesThePlaceOfADoubtfulFit) {
  const twin::RenderedTable rendered = AppleAndBox();
  const twin::TableObject& box = rendered.scene.objects[1];
  twin::TableReconstruction table;
  table.camera = kEye;
  twin::ReconstructedObject object;
  object.fit.instance = box.instance;
  object.fit.pose = {0.1, 1.0, 0.5};
  object.confidence = 0.1;
  table.objects.push_back(object);
  twin::Detections detections;
  detections.objects.push_back(rendered.detections[1]);
  // Moved by (0.3, -0.2) and turned by 90 degrees against this photo.
  TwinPlacements placements;
  placements.poses.push_back({0.4, 0.8, 0.5 + 0.5 * M_PI});
  placements.seen_in.push_back({0, 1});
  std::map<std::string, int> names;
  core::Progress progress;
  core::Findings findings;
  const std::vector<TwinObject> objects =
      WriteTwinAssets({table, rendered.picture.color, detections, {}, placements, 0.25, 1},
                      Path("assets"), &names, &progress, &findings);
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_FALSE(Has(findings, "twin-free-form-failed"));
  EXPECT_EQ(objects[0].source, TwinSource::kLifted);
  EXPECT_EQ(objects[0].name, "cereal_box_1");
  EXPECT_NEAR(objects[0].world_from_object.translation().x(), 0.4, 1e-9);
  EXPECT_NEAR(objects[0].world_from_object.translation().y(), 0.8, 1e-9);
  const assets::Asset asset = assets::ReadAsset(Path("assets/cereal_box_1"));
  EXPECT_NEAR(
      core::Bounds(asset.visual.mesh).sizes().z() / core::Bounds(box.visual.mesh).sizes().z(), 1.0,
      0.05);
  // Seen from the camera of this photo, turned and moved as the object, its outline is the box's.
  Eigen::Isometry3d move =
      placements.poses[0].WorldFromObject() * object.fit.pose.WorldFromObject().inverse();
  core::Camera camera = rendered.scene.camera;
  camera.world_from_camera =
      objects[0].world_from_object.inverse() * move * camera.world_from_camera;
  const library_fit::PhotoAgreement agreement = library_fit::AgreementWithPhoto(
      asset.visual, camera,
      library_fit::FitPhotoOf(rendered.picture.color, rendered.detections[1].alpha));
  EXPECT_GT(agreement.iou, 0.7);
}

}  // namespace
}  // namespace simwright::workflows
