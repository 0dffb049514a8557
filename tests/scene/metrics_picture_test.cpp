// Label renders, features learned from them, and penetration depths of boxes.
#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "core/random.h"
#include "nn/torch_script.h"
#include "scene/metrics/feature_network.h"
#include "scene/metrics/feature_training.h"
#include "scene/metrics/frechet.h"
#include "scene/metrics/penetration.h"
#include "scene/metrics/scene_features.h"
#include "scene/scene_types/scene_types.h"
#include "tests/sanitized.h"

namespace simwright::scene {
namespace {

using MetricsPictureObjects = std::vector<SceneObject>;

// Returns a box of half sizes (x, y) and height z above its base.
core::TriangleMesh Box(double x, double y, double z) {
  core::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : 0.0);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

sim::RigidBody Body(const std::vector<core::TriangleMesh>& parts) {
  sim::RigidBody body;
  body.name = "box";
  body.parts = parts;
  body.inertial.mass = 1.0;
  body.inertial.inertia = Eigen::Matrix3d::Identity();
  return body;
}

// A cube of 20 cm, a tray of two walls 40 cm apart, a table of 1 m by 1 m.
AssetSet Boxes() {
  AssetSet asset_set;
  asset_set.Add("cube", Body({Box(0.1, 0.1, 0.2)}));
  core::TriangleMesh left = Box(0.02, 0.2, 0.3), right = left;
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(-0.2, 0.0, 0.0)), &left);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(0.2, 0.0, 0.0)), &right);
  asset_set.Add("tray", Body({left, right}));
  asset_set.Add("table", Body({Box(0.5, 0.5, 0.5)}));
  return asset_set;
}

Vocabulary MetricsPictureWords() {
  return {"test", 8, {"cube", "table", "tray"}, {false, true, false}};
}

SceneObject At(const std::string& category, double x, double y, double z) {
  SceneObject object;
  object.category = category;
  object.welded = category == "table";
  object.world_from_object.translation() << x, y, z;
  return object;
}

TEST(TotalPenetration, OfBoxesThatOverlap) {
  const AssetSet asset_set = Boxes();
  for (const BodyShape shape : {BodyShape::kParts, BodyShape::kBox}) {
    EXPECT_EQ(TotalPenetration({}, asset_set, shape), 0.0);
    EXPECT_EQ(TotalPenetration({At("cube", 0, 0, 0), At("cube", 0.3, 0, 0)}, asset_set, shape),
              0.0);
    // Two overlap by 3 cm along x; the second and the third by 1 cm along z.
    const MetricsPictureObjects row = {At("cube", 0, 0, 0), At("cube", 0.17, 0, 0),
                                       At("cube", 0.25, 0, 0.19)};
    EXPECT_NEAR(TotalPenetration(row, asset_set, shape), 0.04, 1e-6);
    // Welded objects count against free ones, not against each other.
    const MetricsPictureObjects tables = {At("table", 0, 0, 0), At("table", 0.5, 0, 0),
                                          At("cube", -0.3, 0, 0.48)};
    EXPECT_NEAR(TotalPenetration(tables, asset_set, shape), 0.02, 1e-6);
  }
}

TEST(TotalPenetration, HollowThingsAreFullAsBoxes) {
  const AssetSet asset_set = Boxes();
  const MetricsPictureObjects inside = {At("tray", 0, 0, 0), At("cube", 0, 0, 0.25)};
  EXPECT_EQ(TotalPenetration(inside, asset_set, BodyShape::kParts), 0.0);
  EXPECT_NEAR(TotalPenetration(inside, asset_set, BodyShape::kBox), 0.05, 1e-6);
  EXPECT_THROW(TotalPenetration({At("spoon", 0, 0, 0)}, asset_set, BodyShape::kParts), core::Error);
}

TEST(LabelColour, AreDistinctAndNotWhite) {
  std::set<std::array<std::uint8_t, 3>> colours = {{255, 255, 255}};
  for (int i = 0; i < kMaxLabels; ++i) colours.insert(LabelColour(i));
  EXPECT_EQ(colours.size(), static_cast<size_t>(kMaxLabels) + 1);
  EXPECT_THROW(LabelColour(-1), core::Error);
  EXPECT_THROW(LabelColour(kMaxLabels), core::Error);
  for (const SceneType& type : SceneTypes()) {
    EXPECT_LE(type.categories.size(), static_cast<size_t>(kMaxLabels)) << type.name;
    EXPECT_EQ(LabelCamera(type.name).width, kLabelWidth);
  }
  EXPECT_THROW(LabelCamera("banquet"), core::Error);
}

TEST(LabelRender, IsTheClassesColoursOnWhite) {
  const AssetSet asset_set = Boxes();
  // 1.7 m above a table's top of 0.785 m; the box's is at 0.5.
  const core::Camera camera = LabelCamera("dimsum");
  const MetricsPictureObjects scene = {At("table", 0, 0, 0.285), At("cube", 0.25, 0.3, 0.785)};
  const core::Image image = LabelRender(scene, MetricsPictureWords(), asset_set, camera);
  ASSERT_EQ(image.width, 640);
  ASSERT_EQ(image.height, 480);
  std::map<std::array<std::uint8_t, 3>, int> seen;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* const at = image.At(x, y);
      ++seen[{at[0], at[1], at[2]}];
    }
  }
  EXPECT_EQ(seen.size(), 3u);
  const double pixel = 1.7 / camera.fx;  // m, on the table
  EXPECT_NEAR(seen[LabelColour(1)] + seen[LabelColour(0)], 1.0 / (pixel * pixel), 2500);
  EXPECT_GT(seen[LabelColour(0)], 500);
  // y to the right, x down: the middle of the cube's top, 1.5 m below.
  const int right = static_cast<int>(320.0 + 0.3 / 1.5 * camera.fx);
  const int down = static_cast<int>(240.0 + 0.25 / 1.5 * camera.fx);
  const std::uint8_t* const cube = image.At(right, down);
  EXPECT_EQ((std::array<std::uint8_t, 3>{cube[0], cube[1], cube[2]}), LabelColour(0));
  // An empty scene is white, and a shelf's camera looks along +x.
  const core::Image none = LabelRender({}, MetricsPictureWords(), asset_set, camera);
  EXPECT_EQ(std::count(none.pixels.begin(), none.pixels.end(), 255), 640 * 480 * 3);
  const core::Camera shelf = LabelCamera("pantry_shelf");
  EXPECT_NEAR(shelf.Project({0.0, -0.2, 0.5}).x(), 320.0 + 0.2 / 1.2 * shelf.fx, 1e-9);
  // The front edge of its lowest board, and a bottle's top on the uppermost.
  EXPECT_LT(shelf.Project({-0.15, 0.0, 0.0}).y(), 480.0);
  EXPECT_GT(shelf.Project({-0.15, 0.0, 1.025}).y(), 0.0);
  EXPECT_THROW(LabelRender({At("spoon", 0, 0, 0)}, MetricsPictureWords(), asset_set, camera),
               core::Error);
}

// A table and 0 to `most` cubes, anywhere in the picture.
MetricsPictureObjects Cubes(int most, core::Rng& rng) {
  MetricsPictureObjects objects = {At("table", 0, 0, 0.285)};
  const auto count = core::UniformIndex(rng, most + 1);
  for (std::int64_t i = 0; i < count; ++i) {
    objects.push_back(
        At("cube", core::Uniform(rng, -0.5, 0.5), core::Uniform(rng, -0.7, 0.7), 0.785));
  }
  return objects;
}

TEST(CountPicture, CountsByQuarters) {
  const AssetSet asset_set = Boxes();
  const core::Camera camera = LabelCamera("dimsum");
  // x down, y to the right: the lower left; the upper right; out of the picture.
  const CountedPicture counted = CountPicture(
      {At("cube", 0.3, -0.4, 0.785), At("cube", -0.3, 0.4, 0.785), At("cube", 3.0, 0.0, 0.785)},
      MetricsPictureWords(), asset_set, camera);
  const std::vector<float> cubes(counted.counts.begin(), counted.counts.begin() + kCountsPerClass);
  EXPECT_EQ(cubes, (std::vector<float>{3, 0, 1, 1, 0}));
  EXPECT_EQ(counted.picture.width, kFeatureWidth);
  EXPECT_EQ(counted.picture.height, kFeatureHeight);
}

TEST(SceneFeatures, LearnToCount) {
  SKIP_UNDER_SANITIZERS();
  core::SetThreadCount(1);
  const AssetSet asset_set = Boxes();
  const core::Camera camera = LabelCamera("dimsum");
  core::Rng rng = core::StreamRng(1, 0);
  std::vector<CountedPicture> pictures;
  for (int i = 0; i < 50; ++i) {
    pictures.push_back(CountPicture(Cubes(5, rng), MetricsPictureWords(), asset_set, camera));
  }
  const core::TemporaryFolder folder;
  FeatureTrainingOptions options;
  options.trainer.steps = 80;
  options.batch = 8;
  core::Progress progress;
  const FeatureTrainingReport report =
      TrainFeatures(pictures, options, folder.path() / "features.pt", &progress);
  EXPECT_EQ(report.pictures, 45);
  EXPECT_EQ(report.held_out, 5);
  EXPECT_LT(report.error, 0.85 * report.error_of_the_mean);
  const SceneFeatures features = SceneFeatures::Load(folder.path() / "features.pt");
  EXPECT_TRUE(features.own());
  // A set of few objects is farther from a set of many than two sets of many from each other.
  const auto set = [&](int most) {
    std::vector<core::Image> images;
    for (int i = 0; i < 30; ++i) {
      images.push_back(features.Resized(
          LabelRender(Cubes(most, rng), MetricsPictureWords(), asset_set, camera)));
    }
    return features.Of(images);
  };
  const FeatureMatrix many = set(5), as_many = set(5), few = set(1);
  EXPECT_EQ(many.cols(), kFeatureSize);
  EXPECT_GT(FrechetDistance(GaussianOf(many), GaussianOf(few)),
            2.0 * FrechetDistance(GaussianOf(many), GaussianOf(as_many)));
  EXPECT_THROW(features.Of({core::Image(20, 20, 3)}), core::Error);
}

TEST(SceneFeatures, TakesAScript) {
  // Means of the channels, as a user's module.
  const core::TemporaryFolder folder;
  torch::jit::script::Module module("means");
  module.define("def forward(self, x):\n  return x.mean([2, 3])\n");
  module.save((folder.path() / "means.pt").string());
  const SceneFeatures features = SceneFeatures::LoadTorchScript(folder.path() / "means.pt", 24);
  EXPECT_FALSE(features.own());
  core::Image red(640, 480, 3, 0);
  for (size_t i = 0; i < red.pixels.size(); i += 3) red.pixels[i] = 255;
  const FeatureMatrix rows = features.Of({features.Resized(red), features.Resized(red)});
  ASSERT_EQ(rows.rows(), 2);
  ASSERT_EQ(rows.cols(), 3);
  EXPECT_NEAR(rows(1, 0), 1.0f, 1e-5);
  EXPECT_NEAR(rows(1, 1), 0.0f, 1e-5);
  EXPECT_THROW(SceneFeatures::LoadTorchScript(folder.path() / "none.pt", 24), core::Error);
  EXPECT_THROW(SceneFeatures::LoadTorchScript(folder.path() / "means.pt", 0), core::Error);
  EXPECT_THROW(SceneFeatures::Load(folder.path() / "means.pt"), core::Error);
}

}  // namespace
}  // namespace simwright::scene
