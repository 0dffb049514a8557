// Asset folders as an asset set, and pictures of its scenes.
#include "scene/asset_set/asset_set_folder.h"

#include <gtest/gtest.h>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "scene/export/scene_picture.h"
#include "tests/assets/sample_articulated.h"
#include "tests/assets/sample_asset.h"

namespace simwright::scene {
namespace {

void WriteSample(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  assets::Asset asset = assets::SampleAsset();
  asset.name = folder.filename().string();
  assets::WriteAsset(asset, folder);
}

TEST(ReadAssetSet, SlotsAreNamesWithoutTheirSeed) {
  const core::TemporaryFolder folder;
  WriteSample(folder.path() / "mug_3");
  WriteSample(folder.path() / "mug_4");
  WriteSample(folder.path() / "apple_2_1");
  WriteSample(folder.path() / "lifted");
  std::filesystem::create_directories(folder.path() / "something_else");
  const AssetSet asset_set = ReadAssetSet(folder.path());
  EXPECT_TRUE(asset_set.Has("mug") && asset_set.Has("apple_2") && asset_set.Has("lifted"));
  EXPECT_FALSE(asset_set.Has("mug_3") || asset_set.Has("apple") || asset_set.Has("something_else"));
  const assets::Asset asset = assets::SampleAsset();
  EXPECT_NEAR(asset_set.At("mug").body.inertial.mass, asset.inertial.mass, 1e-9);
  EXPECT_EQ(asset_set.At("mug").parts.size(), asset.parts.size());
  EXPECT_EQ(asset_set.At("mug").visual.mesh.triangles.size(), asset.visual.mesh.triangles.size());
}

TEST(FoldersForCategories, TakesNamesThenSeedsThenCategories) {
  const core::TemporaryFolder folder;
  for (const char* const name : {"apple", "apple_2", "pear_7", "pear_8", "my_find"}) {
    WriteSample(folder.path() / name);
  }
  // An articulated asset belongs to no category, whatever its name.
  std::filesystem::create_directories(folder.path() / "cabinet");
  assets::WriteArticulatedAsset(assets::SampleArticulated(), folder.path() / "cabinet");
  const std::string category = assets::SampleAsset().parameters.category;
  const CategoryFolders found = FoldersForCategories(
      folder.path(), {"apple", "apple_2", "pear", category, "cabinet", "spoon"});
  EXPECT_EQ(found, (CategoryFolders{{"apple", folder.path() / "apple"},
                                    {"apple_2", folder.path() / "apple_2"},
                                    {"pear", folder.path() / "pear_7"},
                                    {category, folder.path() / "my_find"}}));
}

TEST(ReadAssetSet, SaysWhereThereIsNone) {
  const core::TemporaryFolder folder;
  EXPECT_THROW(ReadAssetSet(folder.path()), core::Error);
  EXPECT_THROW(ReadAssetSet(folder.path() / "gone"), core::Error);
}

TEST(RenderScene, ShowsTheWholeScene) {
  const core::TemporaryFolder folder;
  WriteSample(folder.path() / "mug_1");
  const AssetSet asset_set = ReadAssetSet(folder.path());
  std::vector<SceneObject> objects(2);
  objects[0] = {"mug", "mug", Eigen::Isometry3d::Identity(), false, -1};
  objects[1] = {"mug", "mug", Eigen::Isometry3d(Eigen::Translation3d(1.0, 0.0, 0.0)), false, -1};
  const core::Image picture = RenderFromSide(objects, asset_set, 200);
  ASSERT_EQ(picture.channels, 4);
  int seen = 0, at_the_edge = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const bool covered = picture.At(x, y)[3] > 0;
      seen += covered;
      at_the_edge += covered && (x == 0 || y == 0 || x == 199 || y == 199);
    }
  }
  EXPECT_GT(seen, 50);
  EXPECT_EQ(at_the_edge, 0);
  EXPECT_THROW(RenderFromSide({}, asset_set, 200), core::Error);
}

}  // namespace
}  // namespace simwright::scene
