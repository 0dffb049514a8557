#include "twin/asset_retrieval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "tests/twin/rendered_table.h"

namespace simwright::twin {
namespace {

const TableCamera kSeen{0.62, 0.0, 1.15, 0.7};

// An asset as a folder would give it: an instance of the library in colours of its own.
TableAsset AssetOf(const char* kind, std::uint64_t seed, const Eigen::Vector4f& color) {
  TableAsset asset;
  asset.name = kind;
  asset.visual =
      library_fit::InstanceMesh(library_fit::SampleInstance(library_fit::FindFitKind(kind), seed));
  for (core::Material& material : asset.visual.materials) {
    material.texture = -1;
    material.base_color = color;
  }
  asset.size = core::Bounds(asset.visual.mesh).sizes();
  return asset;
}

std::vector<TableAsset> Assets() {
  return {AssetOf("mug", 1'000'000'021, {0.8f, 0.15f, 0.1f, 1.0f}),
          AssetOf("mug", 1'000'000'021, {0.15f, 0.3f, 0.8f, 1.0f}),
          AssetOf("bottle", 1'000'000'022, {0.2f, 0.6f, 0.3f, 1.0f}),
          AssetOf("cereal_box", 1'000'000'023, {0.8f, 0.6f, 0.1f, 1.0f})};
}

// A table with the blue mug and the box, and fits of the right kind at `scale` times the true
// distance.
struct KnownTable {
  RenderedTable rendered;
  Detections detections;
  TableReconstruction reconstruction;
};

KnownTable TableWith(const std::vector<TableAsset>& assets, double scale) {
  KnownTable known;
  const std::vector<std::pair<int, Eigen::Vector3d>> placed{{1, {-0.1, 0.9, -0.6}},
                                                            {3, {0.14, 1.05, 0.5}}};
  RenderedTable& table = known.rendered;
  for (const auto& [asset, pose] : placed) {
    TableObject object;
    object.visual = assets[static_cast<size_t>(asset)].visual;
    object.world_from_object.linear() =
        Eigen::AngleAxisd(pose.z(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    object.world_from_object.translation() = Eigen::Vector3d(pose.x(), pose.y(), 0.0);
    table.scene.objects.push_back(std::move(object));
  }
  table.scene.table.endless = true;
  Picture(kSeen, &table);
  known.detections.objects = table.detections;
  known.reconstruction.camera = kSeen;
  known.reconstruction.camera.height *= scale;
  known.reconstruction.log_scale_error = scale == 1.0 ? 0.0 : 0.2;
  for (size_t k = 0; k < placed.size(); ++k) {
    ReconstructedObject object;
    object.detection = static_cast<int>(k);
    object.fit.pose = {scale * (placed[k].second.x() + 0.03), scale * placed[k].second.y(), 0.0};
    object.fit.instance.kind = library_fit::FindFitKind(k == 0 ? "mug" : "cereal_box");
    object.fit.agreement.iou = 0.9;
    object.confidence = 0.5;
    known.reconstruction.objects.push_back(object);
  }
  return known;
}

TEST(RetrieveAssets, FindsTheAssetOfTheRightShapeAndColour) {
  const std::vector<TableAsset> assets = Assets();
  KnownTable known = TableWith(assets, 1.0);
  core::Progress progress;
  core::Findings findings;
  RetrieveAssets(known.rendered.picture.color, known.detections, assets, {}, &known.reconstruction,
                 &progress, &findings);
  const std::vector<ReconstructedObject>& objects = known.reconstruction.objects;
  EXPECT_EQ(objects[0].retrieved, 1);
  EXPECT_EQ(objects[1].retrieved, 3);
  EXPECT_NEAR(objects[0].fit.pose.x, -0.1, 0.01);
  EXPECT_NEAR(objects[0].fit.pose.y, 0.9, 0.015);
  EXPECT_NEAR(objects[1].fit.pose.x, 0.14, 0.01);
  EXPECT_NEAR(objects[1].fit.pose.y, 1.05, 0.015);
  EXPECT_EQ(objects[0].fit.instance.size, assets[1].size);
  EXPECT_EQ(objects[0].size_error, 0.0);
  EXPECT_GT(objects[0].confidence, 0.5);
  EXPECT_TRUE(findings.empty());
}

TEST(RetrieveAssets, GivesTheScale) {
  const std::vector<TableAsset> assets = Assets();
  KnownTable known = TableWith(assets, 1.25);
  core::Progress progress;
  core::Findings findings;
  RetrieveAssets(known.rendered.picture.color, known.detections, assets, {}, &known.reconstruction,
                 &progress, &findings);
  EXPECT_NEAR(known.reconstruction.camera.height / kSeen.height, 1.0, 0.03);
  EXPECT_LT(known.reconstruction.log_scale_error, 0.06);
  EXPECT_EQ(known.reconstruction.objects[0].retrieved, 1);
  EXPECT_NEAR(known.reconstruction.objects[0].fit.pose.y, 0.9, 0.03);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "twin-scale-from-assets");
}

TEST(RetrieveAssets, LeavesFitsWithoutAnAsset) {
  const std::vector<TableAsset> assets = Assets();
  KnownTable known = TableWith(assets, 1.0);
  const TableReconstruction before = known.reconstruction;
  core::Progress progress;
  core::Findings findings;
  // The red mug and the bottle are not on the table.
  RetrieveAssets(known.rendered.picture.color, known.detections, {assets[0], assets[2]}, {},
                 &known.reconstruction, &progress, &findings);
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(known.reconstruction.objects[k].retrieved, -1);
    EXPECT_EQ(known.reconstruction.objects[k].fit.pose.x, before.objects[k].fit.pose.x);
    EXPECT_EQ(known.reconstruction.objects[k].confidence, 0.5);
  }
  RetrievalOptions invalid;
  invalid.yaws = 0;
  EXPECT_THROW(RetrieveAssets(known.rendered.picture.color, known.detections, assets, invalid,
                              &known.reconstruction, &progress, &findings),
               core::Error);
}

TEST(ReadTableAssets, NamesWhatIsMissing) {
  const core::TemporaryFolder folder;
  core::Findings findings;
  EXPECT_THROW(ReadTableAssets({folder.path() / "none"}, &findings), core::Error);
  EXPECT_THROW(ReadTableAssets({folder.path()}, &findings), core::Error);
  std::filesystem::create_directory(folder.path() / "broken");
  core::WriteFile(folder.path() / "broken/asset.json", "{");
  EXPECT_TRUE(ReadTableAssets({folder.path()}, &findings).empty());
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "twin-asset-unused");
  EXPECT_EQ(findings[0].place, "broken");
}

}  // namespace
}  // namespace simwright::twin
