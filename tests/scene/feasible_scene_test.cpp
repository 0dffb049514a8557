// Scenes that physics accepts: dimsum tables of drums, and invalid scenes.
#include "scene/feasibility/feasible_scene.h"

#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/mass_properties.h"
#include "library/convex_shapes.h"
#include "scene/scene_types/dimsum.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

// Returns a drum that stands on z = 0, or extends below it by `below`.
sim::RigidBody FeasibleSceneDrum(double radius, double height, double density, double below = 0.0) {
  sim::RigidBody body;
  body.name = "drum";
  body.friction = 0.6;
  body.parts = {library::Rod(Vector3d(0, 0, -below), Vector3d(0, 0, height), radius, 24)};
  const auto properties = geometry::SolidMassProperties(body.parts[0], density);
  body.inertial = {properties.mass, properties.center_of_mass, properties.inertia};
  return body;
}

AssetSet FeasibleSceneDrums() {
  AssetSet asset_set;
  asset_set.Add("table_round", FeasibleSceneDrum(0.625, 0.785, 500.0));
  for (const auto& [category, radius, height] :
       {std::tuple("plate", 0.1, 0.018), std::tuple("cup", 0.05, 0.07),
        std::tuple("teapot", 0.09, 0.13), std::tuple("serving_dish", 0.13, 0.025),
        std::tuple("steamer", 0.1, 0.091), std::tuple("steamer_lid", 0.1, 0.05)}) {
    asset_set.Add(category, FeasibleSceneDrum(radius, height, 300.0));
  }
  return asset_set;
}

// A table, and objects on it or in the air, each with its parent's index.
struct Laid {
  std::string category;
  Vector3d place;
  int parent = 0;
};
std::vector<SceneObject> TableWith(const std::vector<Laid>& things) {
  std::vector<SceneObject> objects = {
      {"table_round", "table", Eigen::Isometry3d::Identity(), true, -1}};
  for (const Laid& object : things) {
    objects.push_back({object.category, object.category,
                       Eigen::Isometry3d(Eigen::Translation3d(object.place)), false,
                       object.parent});
  }
  return objects;
}

SceneSample DrawOf(const AssetSet& asset_set, std::uint64_t stream) {
  core::Rng rng = core::StreamRng(3, stream);
  return SampleGrammar(DimsumTable(asset_set.Sizes()), rng);
}

TEST(MakeFeasible, DimsumTablesStand) {
  const AssetSet asset_set = FeasibleSceneDrums();
  FeasibilityOptions options;
  options.settling.duration = 0.5;  // drums that begin where they stand need no more
  options.settling.watch = 0.5;
  int sound = 0, objects = 0, dropped = 0;
  constexpr int kScenes = 6;
  for (int i = 0; i < kScenes; ++i) {
    const SceneSample sample = DrawOf(asset_set, static_cast<std::uint64_t>(i));
    const FeasibleScene scene = MakeFeasible(sample.objects, asset_set, options);
    EXPECT_TRUE(scene.projected);
    sound += scene.valid;
    objects += static_cast<int>(sample.objects.size());
    dropped += scene.dropped;
    if (!scene.valid) continue;
    EXPECT_LE(scene.penetration, 1e-4);
    EXPECT_LE(scene.drift, 1e-3);
    EXPECT_LT(scene.moved, 2e-3);
    EXPECT_EQ(scene.objects.size() + static_cast<size_t>(scene.dropped), sample.objects.size());
  }
  EXPECT_GE(sound, 5);
  EXPECT_LE(dropped, objects / 20);
}

TEST(MakeFeasible, WhatHangsInTheAirFallsAndIsDropped) {
  const AssetSet asset_set = FeasibleSceneDrums();
  FeasibilityOptions options;
  options.settling.duration = 1.0;
  options.settling.watch = 0.3;
  options.min_objects = 1;
  // Half in the plate: the penetration is resolved.
  const std::vector<SceneObject> objects = TableWith(
      {{"plate", {0.1, 0, 0.785}}, {"cup", {0.9, 0, 0.785}}, {"cup", {-0.04, 0, 0.785}, 1}});
  const FeasibleScene scene = MakeFeasible(objects, asset_set, options);
  EXPECT_TRUE(scene.valid);
  EXPECT_EQ(scene.dropped, 1);
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[2].parent, 1);
  const Vector3d way = scene.objects[2].world_from_object.translation() -
                       scene.objects[1].world_from_object.translation();
  EXPECT_NEAR(way.head<2>().norm(), 0.15, 2e-3);
  EXPECT_EQ(scene.objects[0].world_from_object.matrix(), Eigen::Matrix4d::Identity());
}

// An object that falls by 8 cm is dropped unless it is lowered first.
TEST(MakeFeasible, LowersWhatHangsInTheAir) {
  const AssetSet asset_set = FeasibleSceneDrums();
  FeasibilityOptions options;
  options.settling.duration = 0.5;
  options.settling.watch = 0.3;
  options.min_objects = 1;
  const std::vector<SceneObject> objects =
      TableWith({{"plate", {0.2, 0, 0.805}}, {"cup", {0.2, 0, 0.865}, 1}});
  EXPECT_EQ(MakeFeasible(objects, asset_set, options).dropped, 1);
  options.lowering = 0.1;
  const FeasibleScene scene = MakeFeasible(objects, asset_set, options);
  EXPECT_TRUE(scene.valid);
  EXPECT_EQ(scene.dropped, 0);
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_NEAR(scene.objects[1].world_from_object.translation().z(), 0.785, 2e-4);
  EXPECT_NEAR(scene.objects[2].world_from_object.translation().z(), 0.785 + 0.018, 3e-4);
}

// A fall of 15 mm to the table takes 55 ms, and a pass has 50 ms: the cup still moves during the
// first stability check, and rests in the second pass.
TEST(MakeFeasible, WhatIsOnItsWayIsGivenTime) {
  const AssetSet asset_set = FeasibleSceneDrums();
  FeasibilityOptions options;
  options.settling.duration = 0.05;
  options.settling.watch = 0.1;
  options.min_objects = 1;
  const std::vector<SceneObject> objects =
      TableWith({{"plate", {0.2, 0, 0.785}}, {"cup", {-0.2, 0, 0.8}}});
  const FeasibleScene scene = MakeFeasible(objects, asset_set, options);
  EXPECT_TRUE(scene.valid);
  EXPECT_EQ(scene.dropped, 0);
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_NEAR(scene.objects[2].world_from_object.translation().z(), 0.785, 5e-4);
  options.passes = 1;
  const FeasibleScene hasty = MakeFeasible(objects, asset_set, options);
  EXPECT_FALSE(hasty.valid);
  EXPECT_EQ(hasty.dropped, 1);
}

// Two upright boxes that topple: a category that must stand is dropped, a pear is kept lying.
TEST(MakeFeasible, FruitMayLie) {
  AssetSet asset_set = FeasibleSceneDrums();
  sim::RigidBody box;
  box.name = "box";
  box.friction = 0.6;
  box.parts = {library::Box(Vector3d(-0.02, -0.02, 0.0), Vector3d(0.02, 0.02, 0.1))};
  const auto properties = geometry::SolidMassProperties(box.parts[0], 300.0);
  box.inertial = {properties.mass, properties.center_of_mass, properties.inertia};
  asset_set.Add("can", box);
  asset_set.Add("pear", box);
  FeasibilityOptions options;
  options.settling.duration = 1.0;
  options.settling.watch = 0.3;
  options.min_objects = 1;
  const auto toppling = [](double x) {
    return Eigen::Translation3d(x, 0.0, 0.8) * Eigen::AngleAxisd(0.7, Vector3d::UnitY());
  };
  std::vector<SceneObject> objects(3);
  objects[0] = {"table_round", "table", Eigen::Isometry3d::Identity(), true, -1};
  objects[1] = {"can", "can", Eigen::Isometry3d(toppling(-0.3)), false, 0};
  objects[2] = {"pear", "pear", Eigen::Isometry3d(toppling(0.1)), false, 0};
  const FeasibleScene scene = MakeFeasible(objects, asset_set, options);
  EXPECT_EQ(scene.dropped, 1);
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[1].category, "pear");
  // It lies: its z axis is horizontal.
  EXPECT_NEAR(scene.objects[1].world_from_object.linear()(2, 2), 0.0, 0.02);
  EXPECT_TRUE(scene.valid);
}

TEST(MakeFeasible, TooFewObjectsAreNoScene) {
  const AssetSet asset_set = FeasibleSceneDrums();
  std::vector<SceneObject> objects = {
      {"table_round", "table", Eigen::Isometry3d::Identity(), true, -1}};
  FeasibilityOptions options;
  options.settling.duration = options.settling.watch = 0.01;
  EXPECT_FALSE(MakeFeasible(objects, asset_set, options).valid);
  EXPECT_FALSE(MakeFeasible({}, asset_set, options).valid);
}

TEST(MakeFeasible, RefusesWhatIsNotKnown) {
  const AssetSet asset_set = FeasibleSceneDrums();
  const std::vector<SceneObject> ghost = {
      {"ghost", "ghost", Eigen::Isometry3d::Identity(), false, -1}};
  EXPECT_THROW(MakeFeasible(ghost, asset_set), core::Error);
  FeasibilityOptions options;
  options.passes = 0;
  EXPECT_THROW(MakeFeasible({}, asset_set, options), core::Error);
  AssetSet twice = FeasibleSceneDrums();
  EXPECT_THROW(twice.Add("cup", FeasibleSceneDrum(0.05, 0.07, 300.0)), core::Error);
  EXPECT_THROW(twice.Add("air", sim::RigidBody()), core::Error);
}

TEST(AssetSet, SizesAreThoseOfItsAssets) {
  const CategorySizes sizes = FeasibleSceneDrums().Sizes();
  EXPECT_NEAR(sizes.at("steamer").height, 0.091, 1e-9);
  EXPECT_NEAR(sizes.at("serving_dish").Radius(), 0.13, 1e-9);
  EXPECT_EQ(sizes.at("fork").height, DefaultCategorySizes().at("fork").height);
}

}  // namespace
}  // namespace simwright::scene
