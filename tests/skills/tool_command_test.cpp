#include "skills/tool_command.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "robot/panda_model.h"
#include "tests/skills/skill_scene.h"

namespace simwright::skills {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

std::shared_ptr<const Skill> OfPanda() {
  return MakeSkill(robot::Panda(false), {PickUpCup()});
}

ArmCommand AtHome(const Skill& skill) {
  ArmCommand command;
  command.goal = command.sent = skill.robot->home();
  command.rate = robot::JointVector::Zero(command.sent.size());
  command.leader = skill.robot->gripper.open;
  return command;
}

const robot::JointLimits& LimitsOf(const Skill& skill, Eigen::Index j) {
  return skill.robot->limits[static_cast<size_t>(skill.robot->arm_joints[static_cast<size_t>(j)])];
}

// A target that jumps three times a second, like that of an exploring policy.
TEST(StepCommand, KeepsTheJointsSpeedsAndAccelerationsWhateverIsAskedFor) {
  const auto skill = OfPanda();
  const double dt = 1.0 / skill->options.control_rate;
  ArmCommand command = AtHome(*skill);
  core::Rng rng(3);
  ToolTarget target;
  target.base_from_tool = robot::ForwardKinematics(skill->robot->arm, command.sent);
  robot::JointVector before = command.sent, rate = command.rate;
  double leader = command.leader, leader_rate = 0.0, fastest = 0.0, hardest = 0.0;
  for (int step = 0; step < 1200; ++step) {
    if (step % 20 == 0) {
      target.base_from_tool.translation() =
          Vector3d(core::Uniform(rng, 0.35, 0.6), core::Uniform(rng, -0.3, 0.3),
                   core::Uniform(rng, 0.2, 0.6));
      target.leader = core::Uniform(rng) < 0.5 ? skill->robot->gripper.open : 0.0;
    }
    StepCommand(*skill, target, command.sent, &command);
    for (Eigen::Index j = 0; j < before.size(); ++j) {
      const robot::JointLimits& limits = LimitsOf(*skill, j);
      const double speed = (command.sent[j] - before[j]) / dt;
      const double acceleration = (speed - rate[j]) / dt;
      ASSERT_LE(std::abs(speed), limits.velocity) << "joint " << j << ", step " << step;
      ASSERT_LE(std::abs(acceleration), 0.7 * limits.acceleration + 1e-6)
          << "joint " << j << ", step " << step;
      fastest = std::max(fastest, std::abs(speed) / limits.velocity);
      hardest = std::max(hardest, std::abs(acceleration) / limits.acceleration);
      rate[j] = speed;
    }
    const robot::JointLimits& finger =
        skill->robot->limits[static_cast<size_t>(skill->robot->gripper.joints.front())];
    const double speed = (command.leader - leader) / dt;
    ASSERT_LE(std::abs(speed), finger.velocity + 1e-9) << step;
    ASSERT_LE(std::abs(speed - leader_rate) / dt, 0.7 * finger.acceleration + 1e-6) << step;
    before = command.sent;
    leader = command.leader;
    leader_rate = speed;
  }
  // The limits are reached, not only kept.
  EXPECT_GT(fastest, 0.5);
  EXPECT_NEAR(hardest, 0.7, 1e-6);
}

TEST(StepCommand, GoesAtTheShareOfItsPaceThatItIsGiven) {
  const auto skill = OfPanda();
  const double dt = 1.0 / skill->options.control_rate;
  ToolTarget target;
  double fastest[2], hardest[2];
  int steps[2];
  for (const int slow : {0, 1}) {
    ArmCommand command = AtHome(*skill);
    command.pace = slow ? 0.5 : 1.0;
    robot::JointVector goal = command.sent;
    goal[0] += 1.2;
    goal[3] -= 0.4;
    target.base_from_tool = robot::ForwardKinematics(skill->robot->arm, goal);
    command.goal = command.rest = goal;
    robot::JointVector rate = command.rate;
    fastest[slow] = hardest[slow] = 0.0;
    for (steps[slow] = 0; steps[slow] < 600; ++steps[slow]) {
      const robot::JointVector before = command.sent;
      if ((goal - before).lpNorm<Eigen::Infinity>() < 0.01) break;
      command.goal = goal;
      StepCommand(*skill, target, before, &command);
      const double speed = (command.sent[0] - before[0]) / dt;
      fastest[slow] = std::max(fastest[slow], std::abs(speed));
      hardest[slow] = std::max(hardest[slow], std::abs(speed - rate[0]) / dt);
      rate[0] = speed;
    }
  }
  EXPECT_NEAR(fastest[1], 0.5 * fastest[0], 0.02 * fastest[0]);
  EXPECT_NEAR(hardest[1], 0.5 * hardest[0], 0.02 * hardest[0]);
  EXPECT_GT(steps[1], 1.4 * steps[0]);
}

TEST(StepCommand, StopsAtItsGoalWithoutGoingPastIt) {
  const auto skill = OfPanda();
  ArmCommand command = AtHome(*skill);
  ToolTarget target;
  target.base_from_tool = robot::ForwardKinematics(skill->robot->arm, command.sent);
  target.base_from_tool.translation() += Vector3d(0.05, 0.12, -0.1);
  target.leader = skill->robot->gripper.closed;
  double past = 0.0;
  for (int step = 0; step < 180; ++step) {
    const robot::JointVector from = command.sent;
    StepCommand(*skill, target, from, &command);
    // Once the goal is constant, no joint overshoots it.
    if (step < 30) continue;
    const robot::JointVector way = command.goal - from, left = command.goal - command.sent;
    for (Eigen::Index j = 0; j < way.size(); ++j) {
      if (way[j] * left[j] < 0.0) past = std::max(past, std::abs(left[j]));
    }
  }
  const Isometry3d reached = robot::ForwardKinematics(skill->robot->arm, command.sent);
  EXPECT_LT((reached.translation() - target.base_from_tool.translation()).norm(), 1e-3);
  EXPECT_LT(command.rate.cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT(past, 1e-4);
  EXPECT_NEAR(command.leader, skill->robot->gripper.closed, 1e-6);
  EXPECT_NEAR(command.leader_rate, 0.0, 1e-3);
}

TEST(ActionTarget, TheHandOpensClosesOrStays) {
  const auto skill = OfPanda();
  ArmCommand command = AtHome(*skill);
  command.leader = 0.013;
  const auto leader = [&](float action) {
    const float all[7] = {0, 0, 0, 0, 0, 0, action};
    return ActionTarget(*skill, all, {}, command).leader;
  };
  EXPECT_EQ(leader(0.2f), skill->robot->gripper.open);
  EXPECT_EQ(leader(-0.2f), skill->robot->gripper.closed);
  EXPECT_EQ(leader(0.1f), 0.013);
  EXPECT_EQ(leader(-0.1f), 0.013);
}

TEST(ActionTarget, StaysBackAlongItsAxisWhileItIsOffToASide) {
  const auto skill = OfPanda();
  const ArmCommand command = AtHome(*skill);
  const Isometry3d tool = robot::ForwardKinematics(skill->robot->arm, command.sent);
  const float nothing[7] = {0, 0, 0, 0, 0, 0, 0};
  // Returns how far above the target the tool is sent, for a lateral offset of (x, y).
  const auto back = [&](double x, double y, const Vector3d& motion_direction) {
    const Isometry3d focus = tool * Eigen::Translation3d(x, y, 0.2);
    const Isometry3d target =
        ActionTarget(*skill, nothing, {focus, 0.0, false, motion_direction}, command)
            .base_from_tool;
    EXPECT_LT((focus.inverse() * target.translation()).head<2>().norm(), 1e-12);
    return -(focus.inverse() * target.translation()).z();
  };
  const Vector3d none = Vector3d::Zero(), ahead = -Vector3d::UnitX();
  EXPECT_NEAR(back(0.0, 0.0, none), 0.0, 1e-12);
  EXPECT_NEAR(back(0.02, 0.0, none), 0.0, 1e-12);
  EXPECT_NEAR(back(0.0, 0.045, none), 0.04, 1e-9);  // 2 cm off the free radius
  EXPECT_NEAR(back(0.3, 0.0, none), skill->options.standoff, 1e-12);
  // Along the free direction there is no standoff; against it, and beside it, there is.
  EXPECT_NEAR(back(0.3, 0.0, ahead), 0.0, 1e-12);
  EXPECT_NEAR(back(-0.3, 0.0, ahead), skill->options.standoff, 1e-12);
  EXPECT_NEAR(back(0.3, 0.045, ahead), 0.04, 1e-9);
  // A direction mostly along the axis, as a door's: an offset across it counts.
  EXPECT_NEAR(back(0.045, 0.0, Vector3d(-0.1, 0.0, -0.995)), 0.04 - 2.0 * 0.00045, 1e-9);
}

TEST(ActionTarget, AHandThatPushesComesDownBeforeItGoesForward) {
  const auto skill = OfPanda();
  const ArmCommand command = AtHome(*skill);
  const Isometry3d tool = robot::ForwardKinematics(skill->robot->arm, command.sent);
  const float forward[7] = {0.5f, 0, 0, 0, 0, 0, 0}, back[7] = {-0.5f, 0, 0, 0, 0, 0, 0};
  const auto x = [&](const float* action, double above) {
    const Isometry3d focus = tool * Eigen::Translation3d(0.0, 0.0, above);
    const ActionFrame frame{focus, 0.0, true, -Vector3d::UnitX()};
    return (focus.inverse() * ActionTarget(*skill, action, frame, command).base_from_tool)
        .translation()
        .x();
  };
  EXPECT_NEAR(x(forward, 0.0), 0.5 * skill->options.reach, 1e-7);
  EXPECT_NEAR(x(forward, 0.03), 0.0, 1e-12);
  EXPECT_NEAR(x(back, 0.03), -0.5 * skill->options.reach, 1e-7);
}

TEST(ActionTarget, AHandThatLeansIsMovedInTheLevelFrame) {
  const auto skill = OfPanda();
  const ArmCommand command = AtHome(*skill);
  const double lean = 0.6;
  Isometry3d focus = robot::ForwardKinematics(skill->robot->arm, command.sent);
  focus.rotate(Eigen::AngleAxisd(-lean, Vector3d::UnitY()));  // the gripper is at its target
  const float along[7] = {0.5f, 0, 0, 0, 0, 0, 0};
  const Isometry3d moved =
      focus.inverse() *
      ActionTarget(*skill, along, {focus, lean, false, Vector3d::Zero()}, command).base_from_tool;
  EXPECT_LT((moved.translation() - 0.5 * skill->options.reach * Vector3d::UnitX()).norm(), 1e-7);
  EXPECT_NEAR(Eigen::AngleAxisd(moved.linear()).angle(), lean, 1e-9);
}

// Joints that accelerate in proportion keep to the straight line to their goal; each at its own
// limit, they do not.
TEST(StepCommand, JointsThatAccelerateTogetherStayOnTheirLine) {
  const auto skill = OfPanda();
  const robot::JointVector home = skill->robot->home();
  double farthest[2] = {0.0, 0.0};
  for (const bool together : {false, true}) {
    ArmCommand command = AtHome(*skill);
    command.together = together;
    ToolTarget target;
    target.base_from_tool = robot::ForwardKinematics(skill->robot->arm, home);
    target.base_from_tool.translation() += Vector3d(-0.1, 0.05, 0.12);
    for (int step = 0; step < 3; ++step) StepCommand(*skill, target, command.sent, &command);
    const robot::JointVector way = (command.goal - home).normalized();
    const robot::JointVector moved = command.sent - home;
    ASSERT_GT(moved.norm(), 1e-4);
    farthest[together] = (moved - moved.dot(way) * way).norm() / moved.norm();
  }
  EXPECT_LT(farthest[true], 0.05);
  EXPECT_GT(farthest[false], 2.0 * farthest[true]);
}

}  // namespace
}  // namespace simwright::skills
