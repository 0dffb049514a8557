// Worlds of several objects as OpenUSD. tests/usd judges exported scenes by usd-core and Newton.
#include "assets/usd_world.h"

#include <gtest/gtest.h>

#include "assets/usd_asset.h"
#include "core/error.h"
#include "core/files.h"
#include "tests/assets/sample_world.h"
#include "tests/assets/usd_text.h"

namespace simwright::assets {
namespace {
namespace fs = std::filesystem;

TEST(WorldUsd, ReferencesTheAssetOfEachObjectWhereItIs) {
  const core::TemporaryFolder folder;
  const SampleWorld sample(folder.path());
  const std::string text = WorldUsd("room", sample.objects);
  EXPECT_NE(text.find("defaultPrim = \"room\""), std::string::npos);
  for (const WorldObject& object : sample.objects) {
    const std::string prim = PrimText(text, object.name);
    ASSERT_FALSE(prim.empty()) << object.name;
    EXPECT_NE(prim.find("references = @" + UsdLayerOf(*object.asset) + "@"), std::string::npos);
    EXPECT_NE(prim.find("instanceable = true"), std::string::npos);
    const Eigen::Isometry3d& pose = object.world_from_object;
    EXPECT_EQ(VectorOf(prim, "xformOp:translate"), pose.translation()) << object.name;
    EXPECT_TRUE(
        RotationOf(prim, "xformOp:orient").toRotationMatrix().isApprox(pose.linear(), 1e-14))
        << object.name;
    EXPECT_EQ(prim.find("delete apiSchemas") != std::string::npos, object.welded);
  }
  const std::string floor = PrimText(text, "plane");
  EXPECT_NE(floor.find("PhysicsCollisionAPI"), std::string::npos);
  EXPECT_NE(floor.find("axis = \"Z\""), std::string::npos);
  EXPECT_EQ(NumberOf(text, "physics:gravityMagnitude"), 9.81);
}

// The layers lie where the world looks for them.
TEST(WorldUsd, LayersLieBesideTheAssets) {
  const core::TemporaryFolder folder;
  const SampleWorld sample(folder.path());
  for (const WorldAsset& asset : sample.assets) {
    WriteUsd(UsdOf(asset.asset, {}), folder.path() / "assets" / asset.key, asset.key + ".usda");
    EXPECT_TRUE(fs::exists(folder.path() / "scene" / UsdLayerOf(asset))) << asset.key;
  }
}

TEST(WorldUsd, NamesThatClashAreRefused) {
  const core::TemporaryFolder folder;
  SampleWorld sample(folder.path());
  sample.objects[2].name = sample.objects[1].name;
  EXPECT_THROW(WorldUsd("room", sample.objects), core::Error);
  sample.objects[2].name = "ground";
  EXPECT_THROW(WorldUsd("room", sample.objects), core::Error);
  // "physics" is a prim of the world's own.
  sample.objects[2].name = "physics";
  EXPECT_FALSE(PrimText(WorldUsd("room", sample.objects), "physics_2").empty());
}

}  // namespace
}  // namespace simwright::assets
