#include <gtest/gtest.h>

#include <numbers>

#include "core/error.h"
#include "robot/inverse_kinematics.h"
#include "robot/panda.h"
#include "tests/robot/random_configuration.h"

namespace simwright::robot {
namespace {

Eigen::VectorXd Positions(std::initializer_list<double> values) {
  Eigen::VectorXd q(values.size());
  std::copy(values.begin(), values.end(), q.data());
  return q;
}

// Poses from the manufacturer's joint origins, multiplied independently of this code.
TEST(Panda, ForwardKinematicsMeetsPublishedPoses) {
  const Arm& arm = PandaArm();
  const Eigen::Isometry3d ready = ForwardKinematics(arm, arm.ready);
  EXPECT_LT((ready.translation() - Eigen::Vector3d(0.306890567, 0, 0.486882052)).norm(), 1e-8);
  EXPECT_LT(Eigen::Quaterniond(0, 1, 0, 0).angularDistance(Eigen::Quaterniond(ready.linear())),
            1e-7);
  const Eigen::Isometry3d other =
      ForwardKinematics(arm, Positions({0.1, -0.2, 0.3, -1.5, 0.5, 1.2, -0.7}));
  EXPECT_LT((other.translation() - Eigen::Vector3d(0.346015617, 0.282112390, 0.639389732)).norm(),
            1e-8);
  const Eigen::Quaterniond expected(-0.205092871, 0.513637207, 0.830950836, 0.060286333);
  EXPECT_LT(expected.angularDistance(Eigen::Quaterniond(other.linear())), 1e-7);
}

TEST(Panda, JacobianIsTheDerivative) {
  const Arm& arm = PandaArm();
  core::Rng rng(3);
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::VectorXd q = RandomPosture(arm, rng);
    Eigen::Isometry3d tool;
    const auto jacobian = Jacobian(arm, q, &tool);
    EXPECT_TRUE(tool.isApprox(ForwardKinematics(arm, q), 1e-12));
    for (int j = 0; j < arm.size(); ++j) {
      const double h = 1e-6;
      Eigen::VectorXd less = q, more = q;
      less[j] -= h;
      more[j] += h;
      const Eigen::Isometry3d a = ForwardKinematics(arm, less), b = ForwardKinematics(arm, more);
      const Eigen::Vector3d linear = (b.translation() - a.translation()) / (2 * h);
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(b.linear() * a.linear().transpose()));
      const Eigen::Vector3d angular = turn.axis() * turn.angle() / (2 * h);
      EXPECT_LT((jacobian.col(j).head<3>() - linear).norm(), 1e-7);
      EXPECT_LT((jacobian.col(j).tail<3>() - angular).norm(), 1e-7);
    }
  }
}

TEST(Panda, InverseKinematicsFindsPosesThatExist) {
  const Arm& arm = PandaArm();
  core::Rng rng(5);
  int reached = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Isometry3d tool = ForwardKinematics(arm, RandomPosture(arm, rng));
    const ToolTarget target{tool.translation(), tool.linear().col(2)};
    const InverseKinematicsResult result = SolveInverseKinematics(arm, target, rng);
    reached += result.reached;
    for (int j = 0; j < arm.size(); ++j) {
      EXPECT_GE(result.q[j], arm.joints[j].lower);
      EXPECT_LE(result.q[j], arm.joints[j].upper);
    }
    if (!result.reached) continue;
    const Eigen::Isometry3d found = ForwardKinematics(arm, result.q);
    EXPECT_LT((found.translation() - target.position).norm(), 1e-3 + 1e-12);
    EXPECT_GT(found.linear().col(2).dot(*target.approach), std::cos(0.05) - 1e-12);
  }
  EXPECT_GE(reached, kTrials * 98 / 100);
}

// The reach is 0.855 m to the wrist centre; the hand adds 0.21 m and the last link 0.088 m.
TEST(Panda, WhatIsTooFarIsNotReached) {
  core::Rng rng(1);
  for (const Eigen::Vector3d& far : {Eigen::Vector3d(1.3, 0, 0.4), Eigen::Vector3d(0, 0, 1.9),
                                     Eigen::Vector3d(-0.9, 0.9, 0.8)}) {
    const InverseKinematicsResult result =
        SolveInverseKinematics(PandaArm(), {far, std::nullopt}, rng);
    EXPECT_FALSE(result.reached);
    EXPECT_GT(result.position_error, 0.01);
  }
}

TEST(InverseKinematics, RefusesWhatIsNoTargetOrOption) {
  core::Rng rng(1);
  const ToolTarget target{{std::nan(""), 0, 0}, std::nullopt};
  EXPECT_THROW(SolveInverseKinematics(PandaArm(), target, rng), core::Error);
  InverseKinematicsOptions options;
  options.damping = 0.0;
  EXPECT_THROW(SolveInverseKinematics(PandaArm(), {}, rng, options), core::Error);
  EXPECT_THROW(ForwardKinematics(PandaArm(), Positions({0, 0})), core::Error);
}

}  // namespace
}  // namespace simwright::robot
