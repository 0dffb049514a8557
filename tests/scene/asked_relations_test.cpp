// The relations that a prompt asks for, found in a scene and kept by physics.
#include "scene/feasibility/asked_relations.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/mass_properties.h"
#include "library/convex_shapes.h"
#include "scene/feasibility/feasible_scene.h"
#include "scene/prompt/prompt_agreement.h"

namespace simwright::scene {
namespace {

using Eigen::Vector3d;

SceneObject ObjectAt(const std::string& category, double x, double y) {
  return {category, category, Eigen::Isometry3d(Eigen::Translation3d(x, y, 0.0)), false, -1};
}

Prompt PromptAsking(const std::vector<NamedCount>& names,
                    const std::vector<RelationStatement>& relations) {
  Prompt prompt;
  prompt.kind = PromptKind::kRelations;
  prompt.names = names;
  prompt.and_others = true;
  prompt.relations = relations;
  return prompt;
}

CategorySizes DrumSizes() {
  return {{"cup", RoundSize(0.05, 0.07)},
          {"plate", RoundSize(0.1, 0.018)},
          {"teapot", RoundSize(0.09, 0.13)}};
}

TEST(AskedRelations, OrdinalsCountFromTheLeft) {
  // Left is +y: the second cup is the one at y = 0.
  const std::vector<SceneObject> objects = {ObjectAt("cup", 0.0, 0.0), ObjectAt("cup", 0.0, 0.2),
                                            ObjectAt("teapot", 0.2, 0.0),
                                            ObjectAt("cup", 0.0, -0.2)};
  const auto asked = AskedRelations(
      PromptAsking({{"cup", 3}, {"teapot", 1}}, {{{"cup", 2}, Relation::kLeftOf, {"teapot", 0}}}),
      objects, DrumSizes());
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].subject, 0);
  EXPECT_EQ(asked[0].object, 2);
}

TEST(AskedRelations, WithoutOrdinalThePairThatHoldsOrTheNearest) {
  const std::vector<SceneObject> objects = {ObjectAt("cup", 0.0, 0.3), ObjectAt("cup", 0.25, 0.0),
                                            ObjectAt("teapot", 0.0, 0.0)};
  const auto find = [&](Relation relation) {
    return AskedRelations(
        PromptAsking({{"cup", 2}, {"teapot", 1}}, {{{"cup", 0}, relation, {"teapot", 0}}}), objects,
        DrumSizes());
  };
  EXPECT_EQ(find(Relation::kLeftOf).at(0).subject, 0);     // holds
  EXPECT_EQ(find(Relation::kBehind).at(0).subject, 1);     // holds
  EXPECT_EQ(find(Relation::kInFrontOf).at(0).subject, 1);  // the nearer one
}

TEST(AskedRelations, LeavesOutWhatTheSceneLacks) {
  const Prompt prompt =
      PromptAsking({{"cup", 2}, {"plate", 1}}, {{{"cup", 2}, Relation::kOn, {"plate", 0}}});
  EXPECT_TRUE(AskedRelations(prompt, {ObjectAt("cup", 0, 0)}, DrumSizes()).empty());
  EXPECT_TRUE(AskedRelations(prompt, {ObjectAt("cup", 0, 0), ObjectAt("plate", 1, 0)}, DrumSizes())
                  .empty());
  EXPECT_THROW(AskedRelations(PromptAsking({}, prompt.relations), {}, DrumSizes()), core::Error);
}

// The cup that is there is fixed: a new one is meant, and the teapot that is there.
TEST(AskedRelations, OfNamedObjectsThatMayBeFixed) {
  std::vector<SceneObject> objects = {ObjectAt("cup", 0.0, 0.15), ObjectAt("teapot", 0.0, 0.0),
                                      ObjectAt("cup", 0.3, 0.0)};
  objects[0].welded = objects[1].welded = true;
  const Prompt prompt =
      PromptAsking({{"cup", 1}, {"teapot", 1}}, {{{"cup", 0}, Relation::kLeftOf, {"teapot", 0}}});
  EXPECT_TRUE(AskedRelations(prompt, objects, DrumSizes()).empty());
  EXPECT_TRUE(AskedRelations(prompt, objects, DrumSizes(), {1, 1, 0}).empty());
  const std::vector<char> named = {0, 1, 1};
  const auto asked = AskedRelations(prompt, objects, DrumSizes(), named);
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].subject, 2);
  EXPECT_EQ(asked[0].object, 1);
  EXPECT_THROW(AskedRelations(prompt, objects, DrumSizes(), {1}), core::Error);
  std::vector<SceneObject> moved = objects;
  EstablishRelations(prompt, DrumSizes(), named, &moved);
  for (const size_t fixed : {0u, 1u}) {
    EXPECT_EQ(moved[fixed].world_from_object.matrix(), objects[fixed].world_from_object.matrix());
  }
  const Vector3d at = moved[2].world_from_object.translation();
  EXPECT_GE(at.y(), 0.09);  // beyond the teapot's radius, and nearer to the left than to the back
  EXPECT_LE(std::abs(at.x()), at.y());
}

TEST(AskedRelations, ContradictionsMoveNothing) {
  const std::vector<SceneObject> objects = {ObjectAt("cup", 0.0, 0.4), ObjectAt("teapot", 0, 0)};
  std::vector<SceneObject> moved = objects;
  EstablishRelations(
      PromptAsking({{"cup", 1}, {"teapot", 1}}, {{{"cup", 0}, Relation::kLeftOf, {"teapot", 0}},
                                                 {{"cup", 0}, Relation::kBehind, {"teapot", 0}}}),
      DrumSizes(), {}, &moved);
  for (size_t i = 0; i < objects.size(); ++i) {
    EXPECT_EQ(moved[i].world_from_object.matrix(), objects[i].world_from_object.matrix());
  }
}

TEST(AskedRelations, TiersAreOfTheNearestShelf) {
  SceneObject shelf = ObjectAt("shelf_pantry", 0.0, 0.0);
  shelf.welded = true;
  std::vector<SceneObject> objects = {ObjectAt("cup", 0.0, 0.0), shelf, shelf};
  objects[2].world_from_object.translation().x() = 0.5;
  CategorySizes sizes = DrumSizes();
  sizes["shelf_pantry"] = DefaultCategorySizes().at("shelf_pantry");
  Prompt prompt = PromptAsking({{"cup", 1}}, {});
  prompt.tiers = {{{"cup", 0}, ShelfTier::kSecond}};
  const auto asked = AskedRelations(prompt, objects, sizes);
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_TRUE(asked[0].tier);
  EXPECT_EQ(asked[0].object, 1);
  EstablishRelations(prompt, sizes, {}, &objects);
  EXPECT_EQ(AgreementWith(prompt, objects, sizes).held, 1);
  EXPECT_NEAR(objects[0].world_from_object.translation().x(), 0.0, 1e-9);
}

AssetSet DrumsOfPrompts() {
  AssetSet asset_set;
  for (const auto& [category, size] : DrumSizes()) {
    sim::RigidBody body;
    body.name = category;
    body.friction = 0.6;
    body.parts = {library::Rod(Vector3d::Zero(), Vector3d(0, 0, size.height), size.Radius(), 24)};
    const auto properties = geometry::SolidMassProperties(body.parts[0], 300.0);
    body.inertial = {properties.mass, properties.center_of_mass, properties.inertia};
    asset_set.Add(category, body);
  }
  return asset_set;
}

// A teapot that overlaps a cup and is a little more behind it than left of it leaves it along x
// without the prompt, along y with it.
TEST(AskedRelations, PhysicsKeepsThem) {
  const AssetSet asset_set = DrumsOfPrompts();
  const std::vector<SceneObject> objects = {
      ObjectAt("cup", 0.0, 0.0), ObjectAt("teapot", 0.06, 0.03), ObjectAt("plate", 0.6, 0.0)};
  FeasibilityOptions options;
  const Prompt prompt =
      PromptAsking({{"cup", 1}, {"teapot", 1}}, {{{"teapot", 0}, Relation::kLeftOf, {"cup", 0}}});
  const FeasibleScene free = MakeFeasible(objects, asset_set, options);
  options.prompt = prompt;
  const FeasibleScene kept = MakeFeasible(objects, asset_set, options);
  ASSERT_TRUE(free.valid);
  ASSERT_TRUE(kept.valid);
  EXPECT_EQ(AgreementWith(prompt, free.objects, asset_set.Sizes()).held, 0);
  EXPECT_EQ(AgreementWith(prompt, kept.objects, asset_set.Sizes()).held, 1);
  EXPECT_LT(kept.penetration, 1e-4);
}

}  // namespace
}  // namespace simwright::scene
