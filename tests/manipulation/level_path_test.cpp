// Paths of a tool that stays level, each checked again step by step, beside a microwave with an
// open door.
#include "manipulation/level_path.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "manipulation/ik_solutions.h"
#include "tests/skills/skill_scene.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

struct BesideADoor {
  std::shared_ptr<const skills::Skill> skill = skills::MakeSkill(
      robot::Panda(false), {skills::CloseDoor()}, skills::SkillOptions().ForEvaluation());
  const skills::SkillVariant& variant = skill->variants.front();
  const robot::Arm& arm = skill->robot->arm;
  CollisionChecker clearance{*skill, variant, variant.start};

  // Returns the pose of a tool at `place` that leans by `lean` (rad) and is turned by `yaw` (rad).
  static Isometry3d Leaning(const Vector3d& place, double yaw, double lean = 0.8) {
    Isometry3d tool = Isometry3d::Identity();
    tool.linear() = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) *
                    Vector3d(1.0, -1.0, -1.0).asDiagonal() *
                    Eigen::AngleAxisd(-lean, Vector3d::UnitY()).toRotationMatrix();
    tool.translation() = place;
    return tool;
  }
  std::vector<robot::JointVector> At(const Isometry3d& tool, const robot::JointVector& from) const {
    core::Rng rng = core::StreamRng(2, 0);
    std::vector<robot::JointVector> found;
    for (const IkSolution& solution : SolveIkFromManyStarts(*skill, variant, tool, from, rng)) {
      if (clearance.IsCollisionFree(solution.configuration))
        found.push_back(solution.configuration);
    }
    return found;
  }
  // Returns the angle (rad) between the tools' axes that are vertical at `from`, by the rotation
  // matrices alone.
  double Tilt(const robot::JointVector& from, const robot::JointVector& at) const {
    const Eigen::Matrix3d turned = robot::ForwardKinematics(arm, at).linear() *
                                   robot::ForwardKinematics(arm, from).linear().transpose();
    return std::acos(std::clamp(turned(2, 2), -1.0, 1.0));
  }
};

TEST(LargestTilt, IsTheAngleOfAJointAcrossTheVertical) {
  const BesideADoor scene;
  const robot::JointVector home = scene.skill->robot->home();
  robot::JointVector turned = home, leaning = home;
  turned[0] += 1.0;   // about the vertical
  leaning[1] -= 0.3;  // about a horizontal axis
  EXPECT_NEAR(LargestTilt(*scene.skill, scene.variant, home, {turned}), 0.0, 1e-6);
  EXPECT_NEAR(LargestTilt(*scene.skill, scene.variant, home, {leaning, home}), 0.3, 1e-9);
}

TEST(PlanLevelPath, KeepsTheToolUprightWhereAStraightSegmentDoesNot) {
  const BesideADoor scene;
  const Vector3d begin_at(0.45, -0.3, 0.2);
  const auto begins = scene.At(BesideADoor::Leaning(begin_at, -0.5), scene.skill->robot->home());
  ASSERT_FALSE(begins.empty());
  int planned = 0, tilted = 0;
  for (const Vector3d& place : {Vector3d(0.35, 0.4, 0.2), Vector3d(0.3, 0.35, 0.3),
                                Vector3d(0.4, 0.3, 0.4), Vector3d(0.45, -0.1, 0.35)}) {
    const robot::JointVector& from = begins.front();
    const Isometry3d there = BesideADoor::Leaning(place, 0.4);
    const LevelGoal goal{there, scene.At(there, from),
                         [](const robot::JointVector&) { return true; }};
    for (const robot::JointVector& end : goal.configurations) {
      tilted += LargestTilt(*scene.skill, scene.variant, from, {end}) > kLevelTilt;
    }
    const auto path = PlanLevelPath(*scene.skill, scene.variant, scene.clearance, from, goal);
    if (!path) continue;
    ++planned;
    const Isometry3d arrived = scene.variant.subtask.start.world_from_robot *
                               robot::ForwardKinematics(scene.arm, path->back());
    EXPECT_LT((arrived.translation() - there.translation()).norm(), 0.01);
    EXPECT_LT(Eigen::AngleAxisd(arrived.linear().transpose() * there.linear()).angle(), 0.15);
    robot::JointVector before = from;
    for (const robot::JointVector& next : *path) {
      for (int step = 0; step <= 50; ++step) {
        const robot::JointVector at = before + step / 50.0 * (next - before);
        EXPECT_LE(scene.Tilt(from, at), kLevelTilt + 0.01);
        EXPECT_TRUE(step == 0 || scene.clearance.IsCollisionFree(at));
      }
      before = next;
    }
  }
  EXPECT_GE(planned, 3);
  EXPECT_GE(tilted, 3);  // the segments that the path replaces
}

// The tool turns at its place, or moves by less than poses are apart.
TEST(PlanLevelPath, EndsAtNearGoals) {
  const BesideADoor scene;
  const Vector3d at(0.45, -0.3, 0.3);
  const auto begins = scene.At(BesideADoor::Leaning(at, -0.5), scene.skill->robot->home());
  ASSERT_FALSE(begins.empty());
  for (const Isometry3d& there : {BesideADoor::Leaning(at, 0.1),
                                  BesideADoor::Leaning(at - Vector3d(0.0, 0.0, 0.015), -0.5)}) {
    const LevelGoal goal{there, {}, [](const robot::JointVector&) { return true; }};
    const auto path =
        PlanLevelPath(*scene.skill, scene.variant, scene.clearance, begins.front(), goal);
    ASSERT_TRUE(path);
    const Isometry3d arrived = scene.variant.subtask.start.world_from_robot *
                               robot::ForwardKinematics(scene.arm, path->back());
    EXPECT_LT((arrived.translation() - there.translation()).norm(), 0.01);
    EXPECT_LT(Eigen::AngleAxisd(arrived.linear().transpose() * there.linear()).angle(), 0.15);
  }
}

TEST(PlanLevelPath, FindsNoneWhereTheToolMustTilt) {
  const BesideADoor scene;
  const auto begins =
      scene.At(BesideADoor::Leaning({0.45, -0.3, 0.3}, 0.0, 0.8), scene.skill->robot->home());
  ASSERT_FALSE(begins.empty());
  const Isometry3d there = BesideADoor::Leaning({0.45, -0.2, 0.3}, 0.0, 0.2);
  const LevelGoal goal{there, scene.At(there, begins.front()),
                       [](const robot::JointVector&) { return true; }};
  EXPECT_FALSE(goal.configurations.empty());
  EXPECT_FALSE(PlanLevelPath(*scene.skill, scene.variant, scene.clearance, begins.front(), goal));
}

TEST(PlanLevelPath, EndsOnlyWhereItIsSuitable) {
  const BesideADoor scene;
  const auto begins =
      scene.At(BesideADoor::Leaning({0.45, -0.3, 0.3}, -0.5), scene.skill->robot->home());
  ASSERT_FALSE(begins.empty());
  LevelGoal goal{BesideADoor::Leaning({0.45, -0.1, 0.35}, 0.0), {}, [](const robot::JointVector&) {
                   return true;
                 }};
  const auto plan = [&] {
    return PlanLevelPath(*scene.skill, scene.variant, scene.clearance, begins.front(), goal);
  };
  EXPECT_TRUE(plan());
  goal.is_suitable = [](const robot::JointVector&) { return false; };
  EXPECT_FALSE(plan());
}

TEST(PlanLevelPath, FindsNoneToAGoalOutOfReach) {
  const BesideADoor scene;
  const robot::JointVector home = scene.skill->robot->home();
  const LevelGoal goal{BesideADoor::Leaning({2.0, 0.0, 0.3}, 0.0),
                       {},
                       [](const robot::JointVector&) { return true; }};
  EXPECT_FALSE(PlanLevelPath(*scene.skill, scene.variant, scene.clearance, home, goal));
}

}  // namespace
}  // namespace simwright::manipulation
