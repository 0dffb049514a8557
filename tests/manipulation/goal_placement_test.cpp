// Goals in scenes that differ from the description: unchanged if free, above the object if
// furniture blocks them, moving with the receptacle that the object comes out of.
#include "manipulation/goal_placement.h"

#include <gtest/gtest.h>

#include "manipulation/collision_checker.h"
#include "skills/skill_evaluation.h"
#include "tests/skills/skill_scene.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kCup = 0, kMicrowave = 1;

// Returns a skill that picks up a cup at (0.5, 0), with a microwave at `microwave`.
std::shared_ptr<const skills::Skill> CupAndMicrowave(const Isometry3d& microwave,
                                                     const Vector3d& cup = {0.5, 0.0, 0.0}) {
  skills::SkillSubtask scene = skills::PickUpCup();
  scene.assets.push_back(skills::WithInertia(tasks::Microwave()));
  scene.subtask.start.placements[0].world_from_asset.translation() = cup;
  tasks::AssetPlacement placement;
  placement.asset = "microwave";
  placement.fixed = true;
  placement.world_from_asset = microwave;
  scene.subtask.start.placements.push_back(placement);
  return skills::MakeSkill(robot::Panda(false), {scene}, skills::SkillOptions().ForEvaluation());
}

Isometry3d GoalPlacementAt(double x, double y, double yaw = 0.0) {
  return Eigen::Translation3d(x, y, 0.0) * Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) *
         Isometry3d::Identity();
}

TEST(GoalPlacement, AFreeGoalStaysWhereItIs) {
  const auto skill = CupAndMicrowave(GoalPlacementAt(0.8, 0.6));
  const skills::SkillVariant& variant = skill->variants.front();
  tasks::WorldState state = variant.start;
  EXPECT_EQ(GoalIn(variant, state), Vector3d(0.5, 0.0, 0.2));
  state.roots[kCup].translation() += Vector3d(0.1, -0.1, 0.0);
  EXPECT_EQ(GoalIn(variant, state), Vector3d(0.5, 0.0, 0.2));
}

TEST(GoalPlacement, WhatAMicrowaveIsInTheWayOfIsAboveTheCup) {
  const auto skill = CupAndMicrowave(GoalPlacementAt(0.8, 0.6));
  const skills::SkillVariant& variant = skill->variants.front();
  tasks::WorldState state = variant.start;
  state.roots[kMicrowave] = GoalPlacementAt(0.65, 0.2);
  state.roots[kCup].translation() += Vector3d(-0.1, -0.3, 0.0);
  const Vector3d goal = GoalIn(variant, state);
  EXPECT_NEAR(goal.x(), 0.4, 1e-9);
  EXPECT_NEAR(goal.y(), -0.3, 1e-9);
  EXPECT_NEAR(goal.z(), 0.2, 1e-9);  // as high as described
}

TEST(GoalPlacement, WhatComesOutOfARoomGoesBeforeItWhereverItStands) {
  const auto skill = CupAndMicrowave(GoalPlacementAt(0.9, 0.0), {0.8, 0.0, 0.03});
  const skills::SkillVariant& variant = skill->variants.front();
  const Isometry3d moved = GoalPlacementAt(0.8, 0.2, 0.4);
  tasks::WorldState state = variant.start;
  state.roots[kMicrowave] = moved;
  state.roots[kCup] = moved * GoalPlacementAt(0.9, 0.0).inverse() * state.roots[kCup];
  const Vector3d goal = GoalIn(variant, state);
  const Vector3d expected = moved * (GoalPlacementAt(0.9, 0.0).inverse() * Vector3d(0.5, 0.0, 0.2));
  EXPECT_NEAR((goal - expected).norm(), 0.0, 1e-9);
}

TEST(GoalPlacement, EveryStartThatIsDrawnHasAGoalThatNothingIsInTheWayOf) {
  const auto skill = CupAndMicrowave(GoalPlacementAt(0.7, 0.3));
  const skills::SkillVariant& variant = skill->variants.front();
  int moved = 0;
  for (const skills::StartState& start : skills::SampleStarts(*skill, 40, 3)) {
    const Vector3d object = tasks::LinkPosition(variant.model, start.state, kCup, 0);
    const Vector3d displacement = start.state.goal - object;
    const auto there = tasks::WorldAabb(variant.model, start.state, kCup).translated(displacement);
    EXPECT_FALSE(there.intersects(tasks::WorldAabb(variant.model, start.state, kMicrowave)));
    moved += start.state.goal != variant.start.goal;
  }
  EXPECT_GT(moved, 0);
  EXPECT_LT(moved, 40);
}

TEST(CollisionChecker, FingersAboutAThingMayBeIgnoredAPalmMayNot) {
  const auto skill = skills::MakeSkill(robot::Panda(false), {skills::PickUpCup()},
                                       skills::SkillOptions().ForEvaluation());
  const skills::SkillVariant& variant = skill->variants.front();
  const skills::StartState start = skills::SampleStarts(*skill, 1, 5).front();
  const Isometry3d tool = variant.subtask.start.world_from_robot *
                          robot::ForwardKinematics(skill->robot->arm, start.grasp_configuration);
  tasks::WorldState state = start.state;
  const auto clear = [&](Fingers fingers) {
    return CollisionChecker(*skill, variant, state)
        .IsCollisionFree(start.grasp_configuration, fingers);
  };
  ASSERT_TRUE(clear(Fingers::kCount));
  state.roots[kCup].translation() += 0.04 * tool.linear().col(1);  // one finger is in it
  EXPECT_FALSE(clear(Fingers::kCount));
  EXPECT_TRUE(clear(Fingers::kIgnored));
  state.roots[kCup].translation() -= 0.06 * tool.linear().col(2);  // now the palm is
  EXPECT_FALSE(clear(Fingers::kIgnored));
}

}  // namespace
}  // namespace simwright::manipulation
