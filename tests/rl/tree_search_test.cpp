// Joint paths around obstacles, each checked again step by step.
#include "rl/tree_search.h"

#include <gtest/gtest.h>

#include "rl/posture_search.h"
#include "tests/rl/skill_scene.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Two configurations beside a microwave with an open door, low to its left and to its right.
struct BothSides {
  std::shared_ptr<const Skill> skill =
      MakeSkill(robot::Panda(false), {CloseDoor()}, SkillOptions().ForEvaluation());
  const SkillVariant& variant = skill->variants.front();
  robot::Posture left = At({0.3, 0.55, 0.15}, skill->robot->home());
  robot::Posture right = At({0.6, -0.35, 0.15}, left);

  robot::Posture At(const Vector3d& place, const robot::Posture& from) const {
    Isometry3d tool = Isometry3d::Identity();
    tool.linear() = Vector3d(1.0, -1.0, -1.0).asDiagonal();
    tool.translation() = place;
    core::Rng rng = core::StreamRng(2, 0);
    const auto found = PosturesAt(*skill, variant, tool, from, rng);
    return found.empty() ? robot::Posture() : found.front().posture;
  }
};

TEST(SearchDetour, GetsRoundWhatIsBetween) {
  const BothSides scene;
  const ArmClearance clearance(*scene.skill, scene.variant, scene.variant.start);
  ASSERT_GT(scene.left.size(), 0);
  ASSERT_GT(scene.right.size(), 0);
  ASSERT_TRUE(clearance.IsClear(scene.left));
  ASSERT_TRUE(clearance.IsClear(scene.right));
  ASSERT_FALSE(clearance.IsWayClear(scene.left, scene.right));
  const robot::Arm& arm = scene.skill->robot->arm;
  const auto detour = SearchDetour(arm, clearance, scene.left, scene.right);
  ASSERT_TRUE(detour);
  ASSERT_FALSE(detour->empty());
  Detour way = *detour;
  way.insert(way.begin(), scene.left);
  way.push_back(scene.right);
  int looks = 0, touching = 0;
  for (size_t i = 0; i + 1 < way.size(); ++i) {
    EXPECT_TRUE(clearance.IsWayClear(way[i], way[i + 1])) << i;
    for (int step = 0; step <= 50; ++step) {
      const robot::Posture at = way[i] + step / 50.0 * (way[i + 1] - way[i]);
      ++looks;
      touching += !clearance.IsClear(at);
      for (Eigen::Index j = 0; j < at.size(); ++j) {
        EXPECT_GE(at[j], arm.joints[static_cast<size_t>(j)].lower - 1e-9);
        EXPECT_LE(at[j], arm.joints[static_cast<size_t>(j)].upper + 1e-9);
      }
    }
  }
  EXPECT_LE(touching, looks / 20);  // between two checks it may graze an object
  // The same ends give the same path, and a collision-free straight one has no waypoints.
  EXPECT_EQ(*SearchDetour(arm, clearance, scene.left, scene.right), *detour);
  const robot::Posture home = scene.skill->robot->home();
  robot::Posture turned = home;
  turned[0] -= 0.3;
  const auto straight = SearchDetour(arm, clearance, home, turned);
  ASSERT_TRUE(straight);
  EXPECT_TRUE(straight->empty());
}

TEST(SearchDetour, FindsNoWayIntoAWall) {
  const BothSides scene;
  const ArmClearance clearance(*scene.skill, scene.variant, scene.variant.start);
  const robot::Posture inside = scene.At({0.75, 0.15, 0.15}, scene.left);
  ASSERT_GT(inside.size(), 0);
  ASSERT_FALSE(clearance.IsClear(inside));
  EXPECT_FALSE(SearchDetour(scene.skill->robot->arm, clearance, scene.left, inside));
}

// The clearance also holds at waypoints, where an arm that continues to the next one is never quite
// on its path.
TEST(SearchDetour, KeepsOffThingsAtItsCorners) {
  const BothSides scene;
  constexpr double kMargin = 0.02;
  ArmClearance clearance(*scene.skill, scene.variant, scene.variant.start);
  ArmClearance everywhere(*scene.skill, scene.variant, scene.variant.start);
  clearance.KeepOff(kMargin, {scene.left, scene.right});
  everywhere.KeepOff(kMargin, {});
  const auto detour = SearchDetour(scene.skill->robot->arm, clearance, scene.left, scene.right);
  ASSERT_TRUE(detour);
  int corners = 0;
  for (const robot::Posture& corner : *detour) {
    if ((corner - scene.left).lpNorm<Eigen::Infinity>() < 0.3) continue;
    if ((corner - scene.right).lpNorm<Eigen::Infinity>() < 0.3) continue;
    ++corners;
    EXPECT_TRUE(everywhere.IsWayClear(corner, corner));
  }
  EXPECT_GT(corners, 0);
}

TEST(ArmClearance, KeepsOffThingsHalfWayOnly) {
  const BothSides scene;
  ArmClearance clearance(*scene.skill, scene.variant, scene.variant.start);
  const robot::Posture home = scene.skill->robot->home();
  ASSERT_TRUE(clearance.IsWayClear(home, scene.right));
  clearance.KeepOff(0.01, {home, scene.right});
  EXPECT_TRUE(clearance.IsWayClear(home, scene.right));
  EXPECT_TRUE(clearance.IsClear(home));
  clearance.KeepOff(1.0, {home, scene.right});
  EXPECT_FALSE(clearance.IsWayClear(home, scene.right));
  EXPECT_TRUE(clearance.IsWayClear(home, home));
  EXPECT_TRUE(clearance.IsClear(home));
}

}  // namespace
}  // namespace simwright::rl
