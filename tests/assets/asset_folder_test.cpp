#include "assets/asset_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sdf/sdf.hh>

#include "assets/mesh_import.h"
#include "assets/model_writer.h"
#include "assets/urdf_reader.h"
#include "core/error.h"
#include "core/files.h"
#include "tests/assets/sample_asset.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;

class AssetFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("simwright_asset_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    WriteAsset(SampleAsset(), folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

void ExpectSame(const Inertial& a, const Inertial& b) {
  EXPECT_NEAR(a.mass, b.mass, 1e-12);
  EXPECT_NEAR((a.center_of_mass - b.center_of_mass).norm(), 0.0, 1e-12);
  EXPECT_NEAR((a.inertia - b.inertia).norm() / b.inertia.norm(), 0.0, 1e-12);
}

TEST_F(AssetFolder, ReadsBackWhatItWrote) {
  const Asset written = SampleAsset(), read = ReadAsset(folder_);
  EXPECT_EQ(read.name, written.name);
  ExpectSame(read.inertial, written.inertial);
  EXPECT_EQ(read.solid.vertices.size(), written.solid.vertices.size());
  EXPECT_EQ(read.parts.size(), 1u);
  EXPECT_NEAR((core::Bounds(read.visual.mesh).sizes() - Eigen::Vector3d(0.06, 0.04, 0.1)).norm(),
              0.0, 1e-8);
  EXPECT_EQ(read.visual.materials.back().name, "painted_wood");
}

TEST_F(AssetFolder, ReadsTheFindingsOfItsCreation) {
  Asset asset = SampleAsset();
  asset.findings = {{"size-drawn", core::Severity::kWarning, "", "The height is drawn at random",
                     0.25, "state it"}};
  WriteAsset(asset, folder_);
  const core::Findings read = ReadAsset(folder_).findings;
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].code, "size-drawn");
  EXPECT_EQ(read[0].severity, core::Severity::kWarning);
  EXPECT_EQ(read[0].sentence, asset.findings[0].sentence);
  EXPECT_EQ(read[0].figure, 0.25);
  EXPECT_EQ(read[0].remedy, "state it");
}

TEST_F(AssetFolder, UrdfdomFindsTheSameInertial) {
  const UrdfModel model = ReadUrdf(folder_ / "sample_box.urdf");
  EXPECT_TRUE(model.findings.empty());
  ASSERT_TRUE(model.links[0].inertial.has_value());
  ExpectSame(*model.links[0].inertial, SampleAsset().inertial);
  EXPECT_EQ(model.links[0].collisions.size(), 1u);
}

TEST_F(AssetFolder, LibsdformatFindsTheSameInertial) {
  sdf::Root root;
  const sdf::Errors errors = root.Load((folder_ / "sample_box.sdf").string());
  for (const auto& error : errors) ADD_FAILURE() << error.Message();
  ASSERT_NE(root.Model(), nullptr);
  const auto& inertial = root.Model()->LinkByIndex(0)->Inertial();
  const Inertial ours = SampleAsset().inertial;
  EXPECT_NEAR(inertial.MassMatrix().Mass(), ours.mass, 1e-9);
  const auto center = inertial.Pose().Pos();
  EXPECT_NEAR((Eigen::Vector3d(center.X(), center.Y(), center.Z()) - ours.center_of_mass).norm(),
              0.0, 1e-9);
  const auto moi = inertial.Moi();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(moi(i, j), ours.inertia(i, j), 1e-6 * ours.inertia.norm());
    }
  }
}

TEST_F(AssetFolder, SameAssetSameBytes) {
  const fs::path other = folder_.string() + "_again";
  fs::remove_all(other);
  fs::create_directories(other);
  WriteAsset(SampleAsset(), other);
  for (const auto& entry : fs::directory_iterator(folder_)) {
    EXPECT_EQ(core::ReadFile(entry.path()), core::ReadFile(other / entry.path().filename()))
        << entry.path();
  }
  fs::remove_all(other);
}

TEST_F(AssetFolder, DamagedDescriptionIsOneError) {
  std::ofstream(folder_ / "asset.json") << "{\"format\": 1, \"name\": ";
  EXPECT_THROW(ReadAsset(folder_), core::Error);
  std::ofstream(folder_ / "asset.json") << "{\"format\": 99}";
  EXPECT_THROW(ReadAsset(folder_), core::Error);
}

TEST(FileSafeName, NeverLeadsAnywhere) {
  EXPECT_EQ(FileSafeName("../../etc/passwd"), "etc_passwd");
  EXPECT_EQ(FileSafeName(""), "asset");
  EXPECT_EQ(FileSafeName("Coffee cup #1"), "Coffee_cup_1");
}

}  // namespace
}  // namespace simwright::assets
