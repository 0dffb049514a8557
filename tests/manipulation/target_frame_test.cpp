// The frame in which a policy acts, against the motion of parts and the paths of objects.
#include "manipulation/target_frame.h"

#include <gtest/gtest.h>

#include "manipulation/goal_displacement.h"
#include "skills/observation.h"
#include "skills/skill_environment.h"
#include "tests/skills/skill_scene.h"

namespace simwright::manipulation {
namespace {

using Eigen::Vector3d;

std::shared_ptr<const skills::Skill> TargetFrameMake(const skills::SkillSubtask& scene) {
  return skills::MakeSkill(robot::Panda(false), {scene}, skills::SkillOptions().ForEvaluation());
}

TargetFrame FrameOf(const skills::SkillVariant& variant, const tasks::WorldState& state,
                    double pitch = 0.0) {
  return TargetFrame(variant, state, Vector3d::UnitY(), pitch);
}

// Returns a subtask that pushes a cup by `x` without grasping it.
skills::SkillSubtask PushCup(double x) {
  skills::SkillSubtask scene = skills::PickUpCup();
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    missing = torch.norm(env.get_goal_pose() - env.get_position(\"cup\"), dim=-1)\n"
      "    return -missing, missing <= 0.03\n";
  scene.subtask.goal = Vector3d(0.5 + x, 0.0, 0.05);
  return scene;
}

// The gripper retreats along the segment from where it was: the frame is at most 6 cm ahead of it.
TEST(TargetFrame, RetreatsAlongALine) {
  const auto skill = TargetFrameMake(skills::OpenDoor());
  const skills::SkillVariant& variant = skill->variants.front();
  tasks::WorldState state = variant.start;
  state.opening = 0.08;  // m: released
  state.gripper.translation() = Vector3d(0.4, 0.1, 0.3);
  const Vector3d begin = state.gripper.translation(), way(-0.2, 0.03, 0.15);
  TargetFrame frame(variant, state, Vector3d::UnitY(), 0.0, way);
  ASSERT_TRUE(frame.retreating());
  for (const double share : {0.0, 0.3, 0.6}) {
    // A gripper that has left the line is led back to it.
    state.gripper.translation() = begin + share * way + Vector3d(0.0, 0.005, 0.0);
    for (int i = 0; i < 3; ++i) frame.Update(state);
    const Vector3d next = frame.world_from_target().translation();
    const double done = (next - begin).dot(way) / way.squaredNorm();
    EXPECT_LT((next - begin - done * way).norm(), 1e-9) << share;
    EXPECT_NEAR((done - share) * way.norm(), 0.06, 0.005) << share;
  }
}

TEST(TargetFrame, TheWayThatADoorIsPulledIsFree) {
  const auto skill = TargetFrameMake(skills::OpenDoor());
  const skills::SkillVariant& variant = skill->variants.front();
  const TargetFrame frame = FrameOf(variant, variant.start);
  EXPECT_EQ(frame.lean(), 0.0);
  EXPECT_NEAR(frame.motion_direction().norm(), 1.0, 1e-9);
  EXPECT_LT(frame.motion_direction().z(), -0.9);  // towards the gripper
}

TEST(TargetFrame, TheWayThatADoorIsClosedIsFreeWhereverItIsMet) {
  skills::SkillSubtask scene = skills::OpenDoor();
  scene.subtask.start.joints = {{"microwave", "door_joint", 1.4}};
  const auto skill = TargetFrameMake(scene);
  const skills::SkillVariant& variant = skill->variants.front();
  tasks::WorldState state = variant.start;
  for (const double position : {1.4, 0.2}) {
    state.joints[0][static_cast<size_t>(variant.target->joint)] = position;
    EXPECT_GT(FrameOf(variant, state).motion_direction().x(), 0.9) << position;
  }
}

TEST(TargetFrame, APushedThingIsMetFromBehindInALevelFrame) {
  const auto skill = TargetFrameMake(PushCup(0.2));
  const skills::SkillVariant& variant = skill->variants.front();
  ASSERT_TRUE(Pushes(variant));
  const TargetFrame frame = FrameOf(variant, variant.start, 0.6);
  EXPECT_EQ(frame.lean(), 0.6);
  const Eigen::Isometry3d& target = frame.world_from_target();
  EXPECT_LT((target.linear().col(0) - Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_LT((target.linear().col(2) + Vector3d::UnitZ()).norm(), 1e-9);
  // Its radius and the fingers' distance behind it, below its middle.
  EXPECT_NEAR(target.translation().x(), 0.5 - 0.03 - 0.03, 0.003);
  EXPECT_LT(target.translation().z(), 0.5 * variant.model.objects[0].height());
}

TEST(TargetFrame, AThingThatIsALittlePastItsGoalIsStillMetFromTheSameSide) {
  const auto skill = TargetFrameMake(PushCup(0.2));
  const skills::SkillVariant& variant = skill->variants.front();
  tasks::WorldState state = variant.start;
  TargetFrame frame = FrameOf(variant, state, 0.6);
  const auto direction_at = [&](double x) {
    state.roots[0].translation().x() = x;
    frame.Update(state);
    return frame.world_from_target().linear()(0, 0);
  };
  const double root = variant.start.roots[0].translation().x();
  EXPECT_NEAR(direction_at(root + 0.19), 1.0, 1e-9);
  EXPECT_NEAR(direction_at(root + 0.228), 1.0, 1e-9);
  EXPECT_NEAR(direction_at(root + 0.24), -1.0, 1e-9);
}

// Returns a subtask that places a grasped cup 25 cm aside.
skills::SkillSubtask PutAside() {
  skills::SkillSubtask scene = skills::PickUpCup();
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    missing = torch.norm(env.get_goal_pose() - env.get_position(\"cup\"), dim=-1)\n"
      "    released = torch.logical_not(env.check_grasped(\"cup\"))\n"
      "    return -missing, torch.logical_and(missing <= 0.03, released)\n";
  scene.subtask.goal = Vector3d(0.5, 0.25, 0.05);
  scene.subtask.start.held = "cup";
  return scene;
}

TEST(TargetFrame, WhatHasSlidInTheHandIsBroughtOn) {
  const auto skill = TargetFrameMake(PutAside());
  const skills::SkillVariant& variant = skill->variants.front();
  tasks::WorldState state = variant.start;
  TargetFrame frame = FrameOf(variant, state);
  ASSERT_TRUE(frame.at_destination());
  const Vector3d displacement = manipulation::DisplacementToDestination(variant, state);
  ASSERT_GT(displacement.norm(), 0.2);
  // The gripper has moved to its target without the cup.
  state.grasped = true;
  state.touched = variant.target->object;
  state.gripper = frame.world_from_target();
  for (int i = 0; i < 3; ++i) frame.Update(state);
  EXPECT_TRUE(frame.world_from_target().translation().isApprox(state.gripper.translation(), 1e-9));
  frame.Update(state);
  EXPECT_TRUE(frame.world_from_target().translation().isApprox(
      Vector3d(state.gripper.translation() + displacement), 1e-9));
  // On the path the gripper holds it unchanged.
  state.gripper.translation() += 0.5 * displacement;
  state.roots[static_cast<size_t>(variant.target->object)].pretranslate(0.5 * displacement);
  for (int i = 0; i < 8; ++i) frame.Update(state);
  EXPECT_TRUE(frame.world_from_target().translation().isApprox(
      Vector3d(state.gripper.translation() + 0.5 * displacement), 1e-9));
}

// The floor turns a cup that hangs from its rim upright, about the fingers.
TEST(TargetFrame, WhatHangsTiltedIsAtItsGoalOnceItStands) {
  const auto skill = TargetFrameMake(PutAside());
  const skills::SkillVariant& variant = skill->variants.front();
  const auto cup = static_cast<size_t>(variant.target->object);
  tasks::WorldState state = variant.start;
  TargetFrame frame = FrameOf(variant, state);
  ASSERT_TRUE(frame.at_destination());
  const Vector3d fingers = state.roots[cup] * Vector3d(0.03, 0.0, 0.09);
  const Eigen::AngleAxisd tilt(0.3, Vector3d(0.6, 0.8, 0.0));
  const auto turned = [](const Eigen::AngleAxisd& turn, const Vector3d& about) {
    return Eigen::Translation3d(about) * turn * Eigen::Translation3d(-about);
  };
  const Vector3d grasp =
      variant.start.roots[cup].inverse() *
      (frame.world_from_target().translation() - DisplacementToDestination(variant, variant.start));
  state.roots[cup] = turned(tilt, fingers) * state.roots[cup];
  frame.Update(state);
  // The fingers go to the frame with the cup, which then turns about them.
  const Vector3d held = state.roots[cup] * grasp;
  const Vector3d there = frame.world_from_target().translation();
  state.roots[cup].pretranslate(there - held);
  state.roots[cup] = turned(tilt.inverse(), there) * state.roots[cup];
  EXPECT_LT(DisplacementToDestination(variant, state).norm(), 1e-9);
}

}  // namespace
}  // namespace simwright::manipulation
