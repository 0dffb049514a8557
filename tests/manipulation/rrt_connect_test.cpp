// Joint paths around obstacles, each checked again step by step.
#include "manipulation/rrt_connect.h"

#include <gtest/gtest.h>

#include "manipulation/ik_solutions.h"
#include "tests/skills/skill_scene.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Two configurations beside a microwave with an open door, low to its left and to its right.
struct BothSides {
  std::shared_ptr<const skills::Skill> skill = skills::MakeSkill(
      robot::Panda(false), {skills::CloseDoor()}, skills::SkillOptions().ForEvaluation());
  const skills::SkillVariant& variant = skill->variants.front();
  robot::JointVector left = At({0.3, 0.55, 0.15}, skill->robot->home());
  robot::JointVector right = At({0.6, -0.35, 0.15}, left);

  robot::JointVector At(const Vector3d& place, const robot::JointVector& from) const {
    Isometry3d tool = Isometry3d::Identity();
    tool.linear() = Vector3d(1.0, -1.0, -1.0).asDiagonal();
    tool.translation() = place;
    core::Rng rng = core::StreamRng(2, 0);
    const auto found = SolveIkFromManyStarts(*skill, variant, tool, from, rng);
    return found.empty() ? robot::JointVector() : found.front().configuration;
  }
};

TEST(PlanRrtConnect, GetsRoundWhatIsBetween) {
  const BothSides scene;
  const CollisionChecker clearance(*scene.skill, scene.variant, scene.variant.start);
  ASSERT_GT(scene.left.size(), 0);
  ASSERT_GT(scene.right.size(), 0);
  ASSERT_TRUE(clearance.IsCollisionFree(scene.left));
  ASSERT_TRUE(clearance.IsCollisionFree(scene.right));
  ASSERT_FALSE(clearance.IsPathCollisionFree(scene.left, scene.right));
  const robot::Arm& arm = scene.skill->robot->arm;
  const auto joint_path = PlanRrtConnect(arm, clearance, scene.left, scene.right);
  ASSERT_TRUE(joint_path);
  ASSERT_FALSE(joint_path->empty());
  JointPath path = *joint_path;
  path.insert(path.begin(), scene.left);
  path.push_back(scene.right);
  int looks = 0, touching = 0;
  for (size_t i = 0; i + 1 < path.size(); ++i) {
    EXPECT_TRUE(clearance.IsPathCollisionFree(path[i], path[i + 1])) << i;
    for (int step = 0; step <= 50; ++step) {
      const robot::JointVector at = path[i] + step / 50.0 * (path[i + 1] - path[i]);
      ++looks;
      touching += !clearance.IsCollisionFree(at);
      for (Eigen::Index j = 0; j < at.size(); ++j) {
        EXPECT_GE(at[j], arm.joints[static_cast<size_t>(j)].lower - 1e-9);
        EXPECT_LE(at[j], arm.joints[static_cast<size_t>(j)].upper + 1e-9);
      }
    }
  }
  EXPECT_LE(touching, looks / 20);  // between two checks it may graze an object
  // The same ends give the same path, and a collision-free straight one has no waypoints.
  EXPECT_EQ(*PlanRrtConnect(arm, clearance, scene.left, scene.right), *joint_path);
  const robot::JointVector home = scene.skill->robot->home();
  robot::JointVector turned = home;
  turned[0] -= 0.3;
  const auto straight = PlanRrtConnect(arm, clearance, home, turned);
  ASSERT_TRUE(straight);
  EXPECT_TRUE(straight->empty());
}

TEST(PlanRrtConnect, FindsNoWayIntoAWall) {
  const BothSides scene;
  const CollisionChecker clearance(*scene.skill, scene.variant, scene.variant.start);
  const robot::JointVector inside = scene.At({0.75, 0.15, 0.15}, scene.left);
  ASSERT_GT(inside.size(), 0);
  ASSERT_FALSE(clearance.IsCollisionFree(inside));
  EXPECT_FALSE(PlanRrtConnect(scene.skill->robot->arm, clearance, scene.left, inside));
}

// The clearance also holds at waypoints, where an arm that continues to the next one is never quite
// on its path.
TEST(PlanRrtConnect, KeepsOffThingsAtItsCorners) {
  const BothSides scene;
  constexpr double kMargin = 0.02;
  CollisionChecker clearance(*scene.skill, scene.variant, scene.variant.start);
  CollisionChecker everywhere(*scene.skill, scene.variant, scene.variant.start);
  clearance.SetClearance(kMargin, {scene.left, scene.right});
  everywhere.SetClearance(kMargin, {});
  const auto joint_path =
      PlanRrtConnect(scene.skill->robot->arm, clearance, scene.left, scene.right);
  ASSERT_TRUE(joint_path);
  int corners = 0;
  for (const robot::JointVector& corner : *joint_path) {
    if ((corner - scene.left).lpNorm<Eigen::Infinity>() < 0.3) continue;
    if ((corner - scene.right).lpNorm<Eigen::Infinity>() < 0.3) continue;
    ++corners;
    EXPECT_TRUE(everywhere.IsPathCollisionFree(corner, corner));
  }
  EXPECT_GT(corners, 0);
}

TEST(CollisionChecker, KeepsOffThingsHalfWayOnly) {
  const BothSides scene;
  CollisionChecker clearance(*scene.skill, scene.variant, scene.variant.start);
  const robot::JointVector home = scene.skill->robot->home();
  ASSERT_TRUE(clearance.IsPathCollisionFree(home, scene.right));
  clearance.SetClearance(0.01, {home, scene.right});
  EXPECT_TRUE(clearance.IsPathCollisionFree(home, scene.right));
  EXPECT_TRUE(clearance.IsCollisionFree(home));
  clearance.SetClearance(1.0, {home, scene.right});
  EXPECT_FALSE(clearance.IsPathCollisionFree(home, scene.right));
  EXPECT_TRUE(clearance.IsPathCollisionFree(home, home));
  EXPECT_TRUE(clearance.IsCollisionFree(home));
}

}  // namespace
}  // namespace simwright::manipulation
