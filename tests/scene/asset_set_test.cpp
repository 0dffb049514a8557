// The data of assets for grammars.
#include "scene/asset_set/asset_set.h"

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "core/error.h"

namespace simwright::scene {
namespace {

core::TriangleMesh BoxAt(const Eigen::Vector3d& size, const Eigen::Vector3d& middle) {
  core::TriangleMesh box = assets::BoxMesh(size);
  for (Eigen::Vector3d& vertex : box.vertices) vertex += middle;
  return box;
}

// A tray 0.4 x 0.3, its floor 1 cm thick and 2 cm up, its rim 5 cm high.
sim::RigidBody Tray(double floor_thickness = 0.01) {
  sim::RigidBody body;
  body.name = "tray";
  body.inertial.mass = 1.0;
  body.parts = {BoxAt({0.4, 0.3, floor_thickness}, {0, 0, 0.02 + 0.5 * floor_thickness}),
                BoxAt({0.02, 0.3, 0.05}, {0.19, 0, 0.025}),
                BoxAt({0.02, 0.3, 0.05}, {-0.19, 0, 0.025})};
  return body;
}

TEST(AssetSet, KnowsWhereThingsStandInAThing) {
  AssetSet asset_set;
  asset_set.Add("tray", Tray());
  const CategorySize& size = asset_set.At("tray").size;
  EXPECT_NEAR(size.half_size.x(), 0.2, 1e-12);
  EXPECT_NEAR(size.half_size.y(), 0.15, 1e-12);
  EXPECT_NEAR(size.height, 0.05, 1e-12);
  EXPECT_NEAR(size.rest_height, 0.03, 1e-12);
  EXPECT_EQ(asset_set.Sizes().at("tray").rest_height, size.rest_height);
  EXPECT_EQ(asset_set.Sizes().at("plate").height, DefaultCategorySizes().at("plate").height);
}

TEST(AssetSet, AnotherAssetHasAnotherHash) {
  AssetSet one, same, thicker, heavier;
  one.Add("tray", Tray());
  same.Add("tray", Tray());
  thicker.Add("tray", Tray(0.0101));
  sim::RigidBody heavy = Tray();
  heavy.inertial.mass = 1.1;
  heavier.Add("tray", heavy);
  EXPECT_EQ(one.HashOf("tray"), same.HashOf("tray"));
  EXPECT_NE(one.HashOf("tray"), thicker.HashOf("tray"));
  EXPECT_NE(one.HashOf("tray"), heavier.HashOf("tray"));
  EXPECT_THROW(one.HashOf("cup"), core::Error);
}

// A tray as its hull: the object inside then stands on it.
TEST(AssetSet, TakesAHollowThingAsItsHull) {
  AssetSet asset_set;
  asset_set.Add("tray", Tray());
  EXPECT_GT(asset_set.At("tray").parts.size(), 1u);
  const std::string hollow = asset_set.HashOf("tray");
  const CategorySize before = asset_set.At("tray").size;
  asset_set.UseConvexHullCollision("tray");
  const SceneAsset& asset = asset_set.At("tray");
  ASSERT_EQ(asset.parts.size(), 1u);
  ASSERT_EQ(asset.body.parts.size(), 1u);
  EXPECT_NEAR(asset.size.height, before.height, 1e-12);
  EXPECT_LT(before.rest_height, before.height);
  EXPECT_NEAR(asset.size.rest_height, before.height, 1e-12);
  EXPECT_EQ(asset.body.inertial.mass, Tray().inertial.mass);  // the matter is where it was
  EXPECT_NE(asset_set.HashOf("tray"), hollow);
  EXPECT_THROW(asset_set.UseConvexHullCollision("mug"), core::Error);
}

TEST(AssetSet, RefusesWhatIsNone) {
  AssetSet asset_set;
  asset_set.Add("tray", Tray());
  EXPECT_THROW(asset_set.Add("tray", Tray()), core::Error);
  EXPECT_THROW(asset_set.Add("cup", sim::RigidBody{}), core::Error);
  EXPECT_THROW(asset_set.At("cup"), core::Error);
}

}  // namespace
}  // namespace simwright::scene
