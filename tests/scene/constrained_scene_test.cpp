// Objects that find a place among others, which stay.
#include "scene/feasibility/constrained_scene.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/mass_properties.h"
#include "library/convex_shapes.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

constexpr double kTop = 0.7, kCup = 0.07, kPlate = 0.02;  // m, heights

AssetSet ConstrainedAssets() {
  AssetSet asset_set;
  const auto add = [&](const std::string& category, double radius, double height) {
    sim::RigidBody body;
    body.name = category;
    body.friction = 0.6;
    body.parts = {library::Rod(Vector3d::Zero(), Vector3d(0, 0, height), radius, 24)};
    const auto properties = geometry::SolidMassProperties(body.parts[0], 300.0);
    body.inertial = {properties.mass, properties.center_of_mass, properties.inertia};
    asset_set.Add(category, body);
  };
  add("table", 0.6, kTop);
  add("cup", 0.05, kCup);
  add("plate", 0.1, kPlate);
  return asset_set;
}

SceneObject At(const std::string& category, double x, double y, double z) {
  SceneObject object;
  object.category = category;
  object.world_from_object.translation() << x, y, z;
  object.welded = category == "table";
  return object;
}

ConstrainedScene Constrained(const std::vector<SceneObject>& objects,
                             const std::vector<char>& kept) {
  const AssetSet asset_set = ConstrainedAssets();
  ConstrainedOptions options;
  options.feasibility.lowering = 0.25;
  ConstrainedScene scene = PlaceAmong(objects, kept, asset_set, options);
  CheckFree(kept, asset_set, options, &scene);
  return scene;
}

TEST(ConstrainedScene, NewObjectsMakeWayForKeptOnes) {
  // A cup that is kept, a new one that penetrates it, one in the air, and one beside the table.
  const std::vector<SceneObject> objects = {At("table", 0, 0, 0), At("cup", 0, 0, kTop),
                                            At("cup", 0.04, 0, kTop), At("cup", 0.3, 0, kTop + 0.1),
                                            At("cup", 0.9, 0, kTop)};
  const ConstrainedScene scene = Constrained(objects, {1, 1, 0, 0, 0});
  EXPECT_TRUE(scene.stable);
  EXPECT_EQ(scene.indices, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(scene.dropped, 1);
  EXPECT_LE(scene.penetration, 1e-4);
  EXPECT_LE(scene.kept_displacement, 1e-3);
  EXPECT_TRUE(scene.unstable.empty());
  EXPECT_TRUE(scene.objects[1].world_from_object.isApprox(objects[1].world_from_object, 0.0));
  EXPECT_FALSE(scene.objects[1].welded);
  EXPECT_GT(scene.objects[2].world_from_object.translation().x(), 0.09);
  EXPECT_NEAR(scene.objects[3].world_from_object.translation().z(), kTop, 1e-3);
}

TEST(ConstrainedScene, AnObjectThatWouldToppleAKeptOneIsDropped) {
  // A plate on a cup, off its centre: still, until something stands on its rim.
  const double on_cup = kTop + kCup;
  const std::vector<SceneObject> objects = {
      At("table", 0, 0, 0), At("cup", 0, 0, kTop), At("plate", 0.03, 0, on_cup),
      At("cup", 0.09, 0, on_cup + kPlate + 0.01), At("cup", -0.3, 0, kTop)};
  const ConstrainedScene scene = Constrained(objects, {1, 1, 1, 0, 0});
  EXPECT_TRUE(scene.stable);
  EXPECT_EQ(scene.indices, (std::vector<int>{0, 1, 2, 4}));
  EXPECT_EQ(scene.dropped, 1);
  EXPECT_LE(scene.kept_displacement, 1e-3);
}

TEST(ConstrainedScene, KeptObjectsThatMoveByThemselvesAreNamed) {
  const std::vector<SceneObject> objects = {At("table", 0, 0, 0), At("cup", 0, 0, kTop + 0.05),
                                            At("cup", 0.3, 0, kTop), At("cup", -0.3, 0, kTop)};
  const ConstrainedScene scene = Constrained(objects, {1, 1, 1, 0});
  EXPECT_EQ(scene.unstable, std::vector<int>{1});
  EXPECT_EQ(scene.objects.size(), 4u);
  EXPECT_TRUE(scene.stable) << "all others are";
  EXPECT_THROW(Constrained(objects, {1, 1}), core::Error);
}

}  // namespace
}  // namespace simwright::scene
