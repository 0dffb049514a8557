// A replay reports what goes wrong: other objects that move, an object that is not held, and
// trajectories of other robots.
#include <gtest/gtest.h>

#include "certificate/certificate.h"
#include "certificate_scene.h"
#include "core/error.h"
#include "robot/panda_model.h"

namespace simwright::certificate {
namespace {

const Planner& ReplayPlanner() {
  static const Planner planner(robot::Panda(false));
  return planner;
}

Certificate LiftedApple() {
  static const Certificate certificate =
      Certify(ReplayPlanner(), TableWithApple(), {{kApple, LiftGoal(), InFrontOfTable()}});
  return certificate;
}

Proof ReplayIn(const PlacedScene& scene, const robot::JointTrajectory& trajectory) {
  return Replay(ReplayPlanner(), scene, kApple, LiftGoal(), InFrontOfTable(), trajectory);
}

TEST(Replay, FailsIfTheAppleIsElsewhere) {
  ASSERT_TRUE(LiftedApple().solvable());
  const Proof proof = ReplayIn(TableWithApple(0.15, 0.25), LiftedApple().trajectory);
  EXPECT_FALSE(proof.success);
  EXPECT_EQ(proof.failure, "does not move the object");
}

TEST(Replay, FailsIfAnotherObjectIsInTheWay) {
  ASSERT_TRUE(LiftedApple().solvable());
  // A column where the tool comes from: in the middle of its straight approach.
  const robot::JointTrajectory& trajectory = LiftedApple().trajectory;
  PlacedScene scene = TableWithApple();
  const PlanSegment& approach = LiftedApple().plan->segments[1];
  const Eigen::Vector3d at =
      (InFrontOfTable() *
       robot::ForwardKinematics(robot::Panda(false).arm, approach.waypoints.front()))
          .translation();
  Put("column", BoxModel({0.03, 0.03, 0.3}, 0.1), {at.x() + 0.02, at.y(), 0.4505}, &scene);
  const Proof proof = ReplayIn(scene, trajectory);
  EXPECT_FALSE(proof.success);
  EXPECT_EQ(proof.moved_most, "column");
  EXPECT_GT(proof.others_moved, 0.005);
}

TEST(Replay, FailsIfTheGripperOpensAgain) {
  ASSERT_TRUE(LiftedApple().solvable());
  robot::JointTrajectory trajectory = LiftedApple().trajectory;
  trajectory.positions.col(7).setConstant(0.04);
  const Proof proof = ReplayIn(TableWithApple(), trajectory);
  EXPECT_FALSE(proof.success);
  EXPECT_EQ(proof.failure, "does not move the object");
}

TEST(Replay, IsRepeatable) {
  ASSERT_TRUE(LiftedApple().solvable());
  const Proof first = ReplayIn(TableWithApple(), LiftedApple().trajectory);
  const Proof second = ReplayIn(TableWithApple(), LiftedApple().trajectory);
  EXPECT_TRUE(first.success) << first.failure;
  EXPECT_EQ(first.target_moved, second.target_moved);
  EXPECT_EQ(first.slip, second.slip);
}

TEST(Replay, RejectsTrajectoriesOfOtherRobots) {
  robot::JointTrajectory trajectory = LiftedApple().trajectory;
  trajectory.joints[0] = "elbow";
  EXPECT_THROW(ReplayIn(TableWithApple(), trajectory), core::Error);
  EXPECT_THROW(ReplayIn(TableWithApple(), {}), core::Error);
}

}  // namespace
}  // namespace simwright::certificate
