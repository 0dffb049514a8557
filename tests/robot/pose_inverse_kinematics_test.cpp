#include "robot/pose_inverse_kinematics.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "robot/panda_model.h"
#include "tests/robot/random_configuration.h"

namespace simwright::robot {
namespace {

constexpr double kHalfDegree = 0.5 * std::numbers::pi / 180;

bool WithinLimits(const Arm& arm, const JointVector& q) {
  for (int j = 0; j < arm.size(); ++j) {
    if (!(q[j] >= arm.joints[j].lower && q[j] <= arm.joints[j].upper)) return false;
  }
  return true;
}

// Computes the error with the other kinematics and Eigen's quaternions, independently of the
// solver.
PoseError TrueError(const Arm& arm, const JointVector& q, const Eigen::Isometry3d& target) {
  const Eigen::Isometry3d tool = ForwardKinematics(arm, q);
  return {(tool.translation() - target.translation()).norm(),
          Eigen::Quaterniond(tool.linear()).angularDistance(Eigen::Quaterniond(target.linear()))};
}

class EveryArm : public testing::TestWithParam<const char*> {
 protected:
  EveryArm()
      : model_(ReadRobot(std::filesystem::path(SIMWRIGHT_SOURCE_DIR) / "robots" / GetParam())) {}
  const RobotModel model_;
};

TEST_P(EveryArm, FastKinematicsAreTheSame) {
  const ChainKinematics chain(model_.arm);
  core::Rng rng(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::VectorXd q = RandomPosture(model_.arm, rng);
    Eigen::Isometry3d slow_tool;
    const auto slow = Jacobian(model_.arm, q, &slow_tool);
    ToolJacobian fast;
    const Eigen::Isometry3d tool = chain.Tool(q, &fast);
    EXPECT_LT((tool.matrix() - slow_tool.matrix()).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((chain.Tool(q).matrix() - slow_tool.matrix()).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((fast - slow).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST_P(EveryArm, FindsPosesThatExist) {
  const PoseInverseKinematics solver(model_.arm);
  core::Rng rng(2);
  constexpr int kPoses = 1000;
  int reached = 0;
  for (int i = 0; i < kPoses; ++i) {
    const Eigen::Isometry3d target = ForwardKinematics(model_.arm, RandomPosture(model_.arm, rng));
    const PoseSolution solution = solver.Solve(target, model_.home(), rng);
    ASSERT_TRUE(WithinLimits(model_.arm, solution.q));
    const PoseError error = TrueError(model_.arm, solution.q, target);
    EXPECT_NEAR(error.position, solution.error.position, 1e-9);
    EXPECT_NEAR(error.angle, solution.error.angle, 1e-7);
    reached += error.position <= 1e-3 && error.angle <= kHalfDegree;
  }
  EXPECT_GE(reached, 995);
}

TEST_P(EveryArm, SameSeedSamePosture) {
  const PoseInverseKinematics solver(model_.arm);
  core::Rng rng(3);
  const Eigen::Isometry3d target = ForwardKinematics(model_.arm, RandomPosture(model_.arm, rng));
  core::Rng first(7), second(7);
  EXPECT_EQ(solver.Solve(target, model_.home(), first).q,
            solver.Solve(target, model_.home(), second).q);
}

INSTANTIATE_TEST_SUITE_P(Robots, EveryArm,
                         testing::Values("panda/panda.urdf", "panda/panda_on_base.urdf",
                                         "generic6/generic6.urdf"));

JointVector StepsOf(const RobotModel& model, double seconds) {
  JointVector steps(model.arm.size());
  const std::vector<JointLimits> limits = model.ArmLimits();
  for (int j = 0; j < model.arm.size(); ++j) steps[j] = limits[j].velocity * seconds;
  return steps;
}

// A circle of 10 cm in 2 s with a rotating gripper, at 60 Hz.
TEST(Track, FollowsAPathWithinLimitsAndSteps) {
  const RobotModel& model = Panda(false);
  const PoseInverseKinematics solver(model.arm);
  const Eigen::Isometry3d home = ForwardKinematics(model.arm, model.home());
  const JointVector steps = StepsOf(model, 1.0 / 60.0);
  JointVector q = model.home();
  for (int i = 0; i < 600; ++i) {
    const double angle = std::numbers::pi * i / 60.0;
    Eigen::Isometry3d target = home;
    target.translation() += 0.1 * Eigen::Vector3d(0, std::sin(angle), 1.0 - std::cos(angle));
    target.rotate(Eigen::AngleAxisd(0.3 * std::sin(angle), Eigen::Vector3d::UnitX()));
    const JointVector before = q;
    const PoseError said = solver.Track(target, steps, &q);
    ASSERT_TRUE(WithinLimits(model.arm, q));
    for (int j = 0; j < 7; ++j) EXPECT_LE(std::abs(q[j] - before[j]), steps[j] * (1 + 1e-12));
    const PoseError error = TrueError(model.arm, q, target);
    EXPECT_NEAR(error.position, said.position, 1e-9);
    EXPECT_LT(error.position, 1e-3);
    EXPECT_LT(error.angle, kHalfDegree);
  }
}

// Returns |weighted error|^2 of a configuration: the cost that tracking minimizes.
double Misses(const Arm& arm, const JointVector& q, const Eigen::Isometry3d& target) {
  const PoseError error = TrueError(arm, q, target);
  const double angle = PoseInverseKinematicsOptions().angle_weight * error.angle;
  return error.position * error.position + angle * angle;
}

// Out of reach, tracking converges to a point where no small motion within the limits reduces the
// error.
TEST(Track, ComesToRestAsNearAsCanBe) {
  const RobotModel& model = Panda(false);
  const PoseInverseKinematics solver(model.arm);
  const JointVector steps = StepsOf(model, 1.0 / 60.0);
  core::Rng rng(4);
  for (const Eigen::Vector3d& far :
       {Eigen::Vector3d(1.5, 0.2, 0.4), Eigen::Vector3d(0.1, 0, 1.9),
        Eigen::Vector3d(-1.0, 0.9, 0.8), Eigen::Vector3d(0, 0, -0.8)}) {
    Eigen::Isometry3d target = ForwardKinematics(model.arm, model.home());
    target.translation() = far;
    JointVector q = model.home(), before = q;
    double largest = 0.0;
    for (int i = 0; i < 3000; ++i) {
      before = q;
      solver.Track(target, steps, &q);
      ASSERT_TRUE(WithinLimits(model.arm, q));
      if (i >= 2900) largest = std::max(largest, (q - before).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(largest, 1e-5) << far.transpose();  // rad a call: no jitter
    const double rest = Misses(model.arm, q, target);
    for (int trial = 0; trial < 2000; ++trial) {
      JointVector other = q;
      for (int j = 0; j < 7; ++j) {
        other[j] = std::clamp(q[j] + 1e-3 * core::Normal(rng), model.arm.joints[j].lower,
                              model.arm.joints[j].upper);
      }
      EXPECT_GT(Misses(model.arm, other, target), rest - 1e-5) << far.transpose();
    }
  }
}

// With the tool at its target, the elbow drifts home and the tool stays.
// Returns a configuration of a 7-joint arm, other than home, with the tool at `target`.
JointVector Elsewhere(const RobotModel& model, const PoseInverseKinematics& solver,
                      const Eigen::Isometry3d& target) {
  core::Rng rng(5);
  JointVector away = model.home();
  away[0] += 0.5;
  away[2] -= 0.6;
  return solver.Solve(target, away, rng).q;
}

TEST(Track, DriftsHomeWithoutMovingTheTool) {
  const RobotModel& model = Panda(false);
  const PoseInverseKinematics solver(model.arm);
  const Eigen::Isometry3d target = ForwardKinematics(model.arm, model.home());
  JointVector q = Elsewhere(model, solver, target);
  ASSERT_GT((q - model.home()).norm(), 0.3);
  const JointVector steps = StepsOf(model, 1.0 / 60.0);
  for (int i = 0; i < 20; ++i) solver.Track(target, steps, &q);
  for (int i = 0; i < 600; ++i) {
    const PoseError error = solver.Track(target, steps, &q);
    EXPECT_LT(error.position, 1e-3);
    EXPECT_LT(error.angle, kHalfDegree);
  }
  EXPECT_LT((q - model.home()).norm(), 0.02);
}

TEST(Track, DriftsToRestWhereThatIsNotHome) {
  const RobotModel& model = Panda(false);
  const PoseInverseKinematics solver(model.arm);
  const Eigen::Isometry3d target = ForwardKinematics(model.arm, model.home());
  const JointVector rest = Elsewhere(model, solver, target);
  ASSERT_GT((rest - model.home()).norm(), 0.3);
  JointVector q = model.home();
  const JointVector steps = StepsOf(model, 1.0 / 60.0);
  for (int i = 0; i < 600; ++i) {
    const PoseError error = solver.Track(target, steps, &q, &rest);
    EXPECT_LT(error.position, 1e-3);
    EXPECT_LT(error.angle, kHalfDegree);
  }
  EXPECT_LT((q - rest).norm(), 0.02);
}

TEST(Track, PutsAPostureOutsideItsLimitsBack) {
  const RobotModel& model = Panda(false);
  const PoseInverseKinematics solver(model.arm);
  JointVector q = JointVector::Constant(7, 9.0);
  solver.Track(ForwardKinematics(model.arm, model.home()), StepsOf(model, 1.0 / 60.0), &q);
  EXPECT_TRUE(WithinLimits(model.arm, q));
}

TEST(PoseInverseKinematics, SaysWhatItDidNotReach) {
  const RobotModel& model = Panda(false);
  const PoseInverseKinematics solver(model.arm);
  core::Rng rng(6);
  Eigen::Isometry3d target = ForwardKinematics(model.arm, model.home());
  target.translation() = Eigen::Vector3d(1.4, 0, 0.5);
  const PoseSolution solution = solver.Solve(target, model.home(), rng);
  EXPECT_FALSE(solution.reached);
  EXPECT_GT(solution.error.position, 0.1);
  EXPECT_TRUE(WithinLimits(model.arm, solution.q));
}

TEST(PoseInverseKinematics, RefusesWhatIsNoTargetOptionOrArm) {
  const RobotModel& model = Panda(false);
  const PoseInverseKinematics solver(model.arm);
  core::Rng rng(1);
  Eigen::Isometry3d target = Eigen::Isometry3d::Identity();
  EXPECT_THROW(solver.Solve(target, JointVector::Zero(6), rng), core::Error);
  target.translation().x() = std::nan("");
  EXPECT_THROW(solver.Solve(target, model.home(), rng), core::Error);
  PoseInverseKinematicsOptions options;
  options.angle_weight = 0.0;
  EXPECT_THROW(PoseInverseKinematics(model.arm, options), core::Error);
  Arm long_arm = model.arm;
  long_arm.joints.resize(kMostJoints + 1);
  EXPECT_THROW(PoseInverseKinematics{long_arm}, core::Error);
  Arm homeless = model.arm;
  homeless.ready.resize(0);
  EXPECT_THROW(PoseInverseKinematics{homeless}, core::Error);
}

}  // namespace
}  // namespace simwright::robot
