// Relations of hand-made scenes, with positions computed by hand.
#include "scene/prompt/relation.h"

#include <gtest/gtest.h>

#include <numbers>

#include "scene/scene_types/shelf_boards.h"

namespace simwright::scene {
namespace {

PlacedBox RelationBox(const std::string& category, double x, double y, double z, double yaw = 0.0) {
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
  return BoxOf(SizeOf(DefaultCategorySizes(), category), pose);
}

std::vector<Relation> All(const PlacedBox& a, const PlacedBox& b) {
  return RelationsBetween(a, b);
}

TEST(PromptRelation, BoxesFollowTheRotation) {
  // A cereal box of 0.07 x 0.19 x 0.28 m, rotated by a right angle about z, and lying on its side.
  const PlacedBox turned = RelationBox("cereal_box", 1.0, 2.0, 0.5, 0.5 * std::numbers::pi);
  EXPECT_TRUE(turned.half.isApprox(Eigen::Vector3d(0.095, 0.035, 0.14), 1e-12));
  EXPECT_TRUE(turned.center.isApprox(Eigen::Vector3d(1.0, 2.0, 0.64), 1e-12));
  const Eigen::Isometry3d lying =
      Eigen::Isometry3d(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()));
  const PlacedBox side = BoxOf(SizeOf(DefaultCategorySizes(), "cereal_box"), lying);
  EXPECT_TRUE(side.half.isApprox(Eigen::Vector3d(0.035, 0.14, 0.095), 1e-12));
  EXPECT_NEAR(side.center.y(), -0.14, 1e-12);
  // A round plate keeps its radius at every yaw; a lying can is 0.126 m long.
  EXPECT_NEAR(RelationBox("plate", 0, 0, 0, 0.25 * std::numbers::pi).half.x(), 0.1, 1e-12);
  const PlacedBox can = BoxOf(SizeOf(DefaultCategorySizes(), "can"), lying);
  EXPECT_TRUE(can.half.isApprox(Eigen::Vector3d(0.0334, 0.063, 0.0334), 1e-9));
}

TEST(PromptRelation, DirectionsAreThoseOfAViewerAtMinusX) {
  const PlacedBox mug = RelationBox("mug", 0, 0, 0.75);
  // Radii 0.05 + 0.05: surfaces 0.05 m apart.
  using R = Relation;
  EXPECT_EQ(All(RelationBox("mug", 0, 0.15, 0.75), mug), (std::vector{R::kLeftOf, R::kNextTo}));
  EXPECT_EQ(All(RelationBox("mug", 0, -0.15, 0.75), mug), (std::vector{R::kRightOf, R::kNextTo}));
  EXPECT_EQ(All(RelationBox("mug", -0.15, 0, 0.75), mug), (std::vector{R::kInFrontOf, R::kNextTo}));
  EXPECT_EQ(All(RelationBox("mug", 0.15, 0, 0.75), mug), (std::vector{R::kBehind, R::kNextTo}));
  // The larger offset decides: 0.15 to the left, 0.1 behind.
  EXPECT_TRUE(Holds(R::kLeftOf, RelationBox("mug", 0.1, 0.15, 0.75), mug));
  EXPECT_FALSE(Holds(R::kBehind, RelationBox("mug", 0.1, 0.15, 0.75), mug));
  // Centres 0.299 m apart leave 0.199 m; 0.301 m are too far.
  EXPECT_TRUE(Holds(R::kLeftOf, RelationBox("mug", 0, 0.299, 0.75), mug));
  EXPECT_TRUE(All(RelationBox("mug", 0, 0.301, 0.75), mug).empty());
  // A box of bases 0.1 m apart (mugs are 0.095 m high) is not level.
  EXPECT_TRUE(All(RelationBox("mug", 0, 0.15, 0.85), mug).empty());
  EXPECT_FALSE(All(RelationBox("mug", 0, 0.15, 0.84), mug).empty());
}

TEST(PromptRelation, OnInsideAboveAndBelow) {
  using R = Relation;
  const PlacedBox plate = RelationBox("plate", 0, 0, 0.75), bowl = RelationBox("bowl", 0, 0, 0.75);
  EXPECT_EQ(All(RelationBox("apple", 0.05, 0, 0.768), plate), std::vector{R::kOn});
  EXPECT_TRUE(All(plate, RelationBox("apple", 0.05, 0, 0.768)).empty());
  // The footprint of a plate is a disc: its corner at 0.08, 0.08 is outside.
  EXPECT_FALSE(Holds(R::kOn, RelationBox("apple", 0.08, 0.08, 0.768), plate));
  // An apple on the floor of a bowl (0.02 m) is inside and on; 0.06 m up it is only on the rim.
  EXPECT_EQ(All(RelationBox("apple", 0, 0, 0.77), bowl), (std::vector{R::kOn, R::kInside}));
  EXPECT_EQ(All(RelationBox("apple", 0, 0, 0.812), bowl), std::vector{R::kOn});
  EXPECT_FALSE(Holds(R::kInside, RelationBox("apple", 0, 0.08, 0.77), bowl));
  EXPECT_FALSE(Holds(R::kInside, RelationBox("apple", 0, 0, 0.74), bowl));
  // Steamers of 0.091 m: the second is on the first, the third above it by 0.091 m.
  const PlacedBox first = RelationBox("steamer", 0, 0, 0.785);
  const PlacedBox second = RelationBox("steamer", 0.002, 0, 0.876);
  const PlacedBox third = RelationBox("steamer", -0.002, 0.001, 0.967);
  EXPECT_EQ(All(second, first), std::vector{R::kOn});
  EXPECT_EQ(All(third, first), std::vector{R::kAbove});
  EXPECT_EQ(All(first, third), std::vector{R::kBelow});
  EXPECT_TRUE(All(first, second).empty());
  // 0.2 m and more above is too far.
  EXPECT_FALSE(Holds(R::kAbove, RelationBox("steamer", 0, 0, 0.876 + 0.201), first));
}

TEST(PromptRelation, APlateUnderABowlIsNeitherOnNorInsideIt) {
  using R = Relation;
  const PlacedBox plate = RelationBox("plate", 0, 0, 0.75);
  const PlacedBox bowl = RelationBox("bowl", 0, 0, 0.754);  // on the plate's floor
  EXPECT_FALSE(Holds(R::kOn, plate, bowl));
  EXPECT_FALSE(Holds(R::kInside, plate, bowl));
  EXPECT_TRUE(Holds(R::kOn, bowl, plate));
}

TEST(PromptRelation, FacingFollowsTheXAxis) {
  const PlacedBox chair = RelationBox("chair", 0, 0, 0);
  const auto at = [](double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    return RelationBox("cup", std::cos(angle), std::sin(angle), 0.0);
  };
  EXPECT_TRUE(Holds(Relation::kFacing, chair, at(0)));
  EXPECT_TRUE(Holds(Relation::kFacing, chair, at(29)));
  EXPECT_FALSE(Holds(Relation::kFacing, chair, at(31)));
  EXPECT_FALSE(Holds(Relation::kFacing, chair, at(180)));
  const PlacedBox turned = RelationBox("chair", 0, 0, 0, 0.5 * std::numbers::pi);
  EXPECT_TRUE(Holds(Relation::kFacing, turned, at(90)));
  EXPECT_FALSE(Holds(Relation::kFacing, chair, chair));
}

TEST(PromptRelation, NamesAreReadBack) {
  for (int i = 0; i < kRelationCount; ++i) {
    const auto relation = static_cast<Relation>(i);
    EXPECT_EQ(RelationNamed(RelationText(relation)), relation);
  }
  EXPECT_EQ(RelationNamed("between"), std::nullopt);
}

TEST(PromptRelation, TiersAreBoardsFromTheTopDown) {
  SceneObject shelf;
  shelf.category = "shelf_pantry";
  shelf.welded = true;
  // The shelf is moved and turned by a half turn.
  shelf.world_from_object = Eigen::Translation3d(1.0, 2.0, 0.1) *
                            Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ());
  const Shelves shelves({shelf}, DefaultCategorySizes());
  const double boards[] = {0.017, 0.287, 0.547, 0.817};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(ShelfBoardHeights()[static_cast<size_t>(i)], boards[i], 1e-12);
    const double z = 0.1 + boards[i];
    const auto expected = static_cast<ShelfTier>(3 - i);
    EXPECT_EQ(shelves.TierOf(RelationBox("can", 1.1, 2.25, z - 0.001)), expected);
    // On another can of the same board.
    EXPECT_EQ(shelves.TierOf(RelationBox("can", 1.1, 2.25, z + 0.126)), expected);
    EXPECT_EQ(shelves.TierOf(RelationBox("can", 1.2, 2.25, z)), std::nullopt);
  }
  EXPECT_EQ(shelves.TierOf(RelationBox("can", 1.1, 2.25, 0.0)), std::nullopt);
}

// The spaces of a shelf that is turned by a right angle: what stands on a board is on its tier, and
// in its space.
TEST(PromptRelation, SpacesOfTiersAreThoseOfTierOf) {
  SceneObject shelf;
  shelf.category = "shelf_pantry";
  shelf.welded = true;
  const auto turn = [&](double yaw) {
    shelf.world_from_object =
        Eigen::Translation3d(1.0, 2.0, 0.1) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
    return Shelves({SceneObject(), shelf}, DefaultCategorySizes());
  };
  const Shelves shelves = turn(0.5 * std::numbers::pi);
  for (int i = 0; i < 4; ++i) {
    const auto tier = static_cast<ShelfTier>(3 - i);
    const std::vector<Shelves::TierSpace> spaces = shelves.SpacesOf(tier);
    ASSERT_EQ(spaces.size(), 1u);
    EXPECT_EQ(spaces[0].object, 1);
    const PlacedBox& space = spaces[0].space;
    EXPECT_NEAR(space.Base(), 0.1 + ShelfBoardHeights()[static_cast<size_t>(i)], 1e-12);
    EXPECT_NEAR(space.half.x(), 0.3, 1e-12);  // 0.6 m wide, 0.3 m deep
    EXPECT_NEAR(space.half.y(), 0.15, 1e-12);
    EXPECT_EQ(shelves.TierOf(RelationBox("can", 1.25, 2.1, space.Base())), tier);
    EXPECT_EQ(BoxDistance(RelationBox("can", 1.25, 2.1, space.Base()), space), 0.0);
  }
  EXPECT_TRUE(turn(0.3).SpacesOf(ShelfTier::kTop).empty());
}

TEST(PromptRelation, OrdinalsCountFromLeftToRight) {
  const std::vector<PlacedBox> boxes = {
      RelationBox("apple", 0, -0.2, 0), RelationBox("apple", 0.3, 0.1, 0),
      RelationBox("apple", 0.1, 0.103, 0.4), RelationBox("apple", 0.1, 0.1, 0),
      RelationBox("apple", 0, 0.5, 0)};
  std::vector<const PlacedBox*> pointers;
  for (const PlacedBox& box : boxes) pointers.push_back(&box);
  EXPECT_EQ(OrdinalOrder(pointers), (std::vector{4, 3, 2, 1, 0}));
}

}  // namespace
}  // namespace simwright::scene
