#include "robot/retiming.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "robot/limit_check.h"
#include "robot/panda_model.h"
#include "tests/robot/recorded_motions.h"

namespace simwright::robot {
namespace {

// Evaluates the trajectory at any time, by cubics through its positions and velocities.
Eigen::RowVectorXd PositionsAt(const JointTrajectory& trajectory, double time) {
  const double h = trajectory.times[1];
  const Eigen::Index i =
      std::min(static_cast<Eigen::Index>(time / h), trajectory.positions.rows() - 2);
  const double x = time / h - static_cast<double>(i);
  const Eigen::RowVectorXd p0 = trajectory.positions.row(i), p1 = trajectory.positions.row(i + 1);
  const Eigen::RowVectorXd v0 = h * trajectory.velocities.row(i),
                           v1 = h * trajectory.velocities.row(i + 1);
  return p0 + x * (v0 + x * (3 * (p1 - p0) - 2 * v0 - v1 + x * (2 * (p0 - p1) + v0 + v1)));
}

struct Property {
  const char* robot;
  MotionKind kind;
  double speed_up = 1.0;
};

class AnyMotion : public testing::TestWithParam<Property> {};

// The guarantees of retiming, measured on its results: the independent check accepts the motion, it
// starts and ends at rest, and it passes each recorded position, in order, within the deviations.
TEST_P(AnyMotion, IsAcceptedAndStaysClose) {
  const RobotModel model =
      ReadRobot(std::filesystem::path(SIMWRIGHT_SOURCE_DIR) / "robots" / GetParam().robot);
  const RetimedJoints joints = JointsToRetime(model);
  RetimingOptions options;
  options.max_speed_up = GetParam().speed_up;
  for (std::uint64_t seed = 100; seed < 103; ++seed) {
    const RecordedPath path = MakeMotion(model, GetParam().kind, 4.0, seed);
    const Retimed retimed = Retime(path, joints.limits, joints.sliding, &model.arm, options);
    const JointTrajectory& trajectory = retimed.trajectory;
    const LimitReport report = CheckLimits(trajectory, joints.limits);
    EXPECT_TRUE(report.accepted())
        << report.findings[0].place << ": " << report.findings[0].sentence;
    const Eigen::Index last = trajectory.size() - 1;
    EXPECT_EQ(trajectory.velocities.row(0).norm() + trajectory.velocities.row(last).norm(), 0.0);
    EXPECT_EQ(trajectory.accelerations.row(0).norm() + trajectory.accelerations.row(last).norm(),
              0.0);
    EXPECT_LT((trajectory.positions.row(0) - path.positions.row(0)).norm(), 1e-6);
    EXPECT_LT((trajectory.positions.row(last) - path.positions.bottomRows(1)).norm(), 1e-6);

    ASSERT_EQ(retimed.waypoint_times.size(), path.times.size());
    for (std::size_t k = 0; k < path.times.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      if (k > 0) {
        EXPECT_GT(retimed.waypoint_times[k], retimed.waypoint_times[k - 1]);
      }
      const Eigen::RowVectorXd q = PositionsAt(trajectory, retimed.waypoint_times[k]);
      for (Eigen::Index j = 0; j < q.size(); ++j) {
        const double allowed = joints.sliding[static_cast<std::size_t>(j)]
                                   ? options.prismatic_deviation
                                   : options.revolute_deviation;
        const double way = std::abs(q[j] - path.positions(row, j));
        ASSERT_LE(way, allowed + 1e-7) << path.joints[static_cast<std::size_t>(j)] << " " << k;
        ASSERT_LE(way, retimed.deviations[j] + 1e-7);
      }
      const Eigen::Vector3d tool =
          ForwardKinematics(model.arm, q.head(model.arm.size())).translation();
      const Eigen::Vector3d recorded =
          ForwardKinematics(model.arm, path.positions.row(row).head(model.arm.size()))
              .translation();
      ASSERT_LE((tool - recorded).norm(), options.tool_deviation + 1e-6);
    }
    EXPECT_NEAR(retimed.stretch, trajectory.times.back() / (path.times.back()), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Motions, AnyMotion,
    testing::Values(Property{"panda/panda.urdf", MotionKind::kSmooth},
                    Property{"panda/panda.urdf", MotionKind::kFast},
                    Property{"panda/panda.urdf", MotionKind::kPolicy},
                    Property{"panda/panda.urdf", MotionKind::kNoisy},
                    Property{"panda/panda.urdf", MotionKind::kCorners},
                    Property{"panda/panda.urdf", MotionKind::kSmooth, 100.0},
                    Property{"panda/panda_on_base.urdf", MotionKind::kSmooth, 100.0},
                    Property{"panda/panda_on_base.urdf", MotionKind::kNoisy, 100.0},
                    Property{"panda/panda_on_base.urdf", MotionKind::kPolicy},
                    Property{"panda/panda_on_base.urdf", MotionKind::kCorners},
                    Property{"generic6/generic6.urdf", MotionKind::kFast},
                    Property{"generic6/generic6.urdf", MotionKind::kPolicy}));

// Returns a motion of one joint along a cosine, over `way` in `seconds`, then at rest for a second.
RecordedPath Cosine(double way, double seconds) {
  RecordedPath path;
  path.joints = {"joint"};
  const auto count = static_cast<Eigen::Index>((seconds + 1.0) * 60.0) + 1;
  path.positions.resize(count, 1);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) / 60.0;
    path.times.push_back(t);
    path.positions(k, 0) =
        0.5 * way * (1.0 - std::cos(std::numbers::pi * std::min(t / seconds, 1.0)));
  }
  return path;
}

const JointLimits kJoint = {-2.0, 2.0, 2.0, 10.0, 5000.0, 0.0};

TEST(Retiming, WhatIsWithinTheLimitsKeepsItsTime) {
  const RecordedPath path = Cosine(1.0, 2.0);  // 0.79 rad/s, 1.23 rad/s^2
  const Retimed retimed = Retime(path, {kJoint}, {false}, nullptr);
  // The only additions are the two ramps, of half their length each, and the last millisecond.
  EXPECT_NEAR(retimed.trajectory.times.back(), 3.0 + RetimingOptions().ramp, 2e-3);
  EXPECT_EQ(retimed.tool_deviation, 0.0);
}

// A motion three times too fast takes three times as long, and the rest of a second keeps its
// length.
TEST(Retiming, SlowsDownWhereTheLimitsAsk) {
  const RecordedPath path = Cosine(1.5, 0.4);  // 5.9 rad/s, limit 2; 46 rad/s^2, limit 10
  const Retimed retimed = Retime(path, {kJoint}, {false}, nullptr);
  const LimitReport report = CheckLimits(retimed.trajectory, {kJoint});
  EXPECT_TRUE(report.accepted());
  EXPECT_GT(report.joints[0].velocity.ratio, 0.95);  // uses the allowed velocity
  // At full acceleration and velocity: 1.5 / 2 + 2 / 10 = 0.95 s.
  const double rest = retimed.waypoint_times.back() - retimed.waypoint_times[24];
  EXPECT_LT(retimed.waypoint_times[24], 1.5);
  EXPECT_GT(retimed.waypoint_times[24], 0.9);
  EXPECT_NEAR(rest, 1.0, 0.15);
}

TEST(Retiming, StretchesLittleMoreThanTheVelocitiesAskFor) {
  const RobotModel& model = Panda(false);
  const RetimedJoints joints = JointsToRetime(model);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const RecordedPath path = MakeMotion(model, MotionKind::kFast, 6.0, seed);
    const Retimed retimed = Retime(path, joints.limits, joints.sliding, &model.arm);
    EXPECT_LT(retimed.stretch, 1.1 * LeastStretch(path, joints.limits) + 0.03);
  }
}

// While the fingers hold in the recording they hold in the motion, and the arm has the recorded
// configuration.
TEST(Retiming, FingersHoldWhileTheyHeld) {
  const RobotModel& model = Panda(false);
  const RetimedJoints joints = JointsToRetime(model);
  const RecordedPath path = MakeMotion(model, MotionKind::kPolicy, 6.0, 9);
  const Retimed retimed = Retime(path, joints.limits, joints.sliding, &model.arm);
  const Eigen::Index finger = model.arm.size();
  const double held = 0.4 * model.gripper.open;
  int checked = 0;
  for (std::size_t k = 3; k + 3 < path.times.size(); ++k) {
    bool holds = true;
    for (std::size_t near = k - 3; near <= k + 3; ++near) {
      holds = holds && path.positions(static_cast<Eigen::Index>(near), finger) == held;
    }
    if (!holds) continue;
    ++checked;
    for (double t = retimed.waypoint_times[k]; t < retimed.waypoint_times[k + 1]; t += 1e-3) {
      EXPECT_NEAR(PositionsAt(retimed.trajectory, t)[finger], held, 5e-4);
    }
  }
  EXPECT_GT(checked, 100);
}

TEST(Retiming, StaysWithinLimitsThatTheRecordingTouches) {
  RecordedPath path = Cosine(1.0, 1.0);
  JointLimits limits = kJoint;
  limits.lower = 0.0005;  // the recording starts half a milliradian below and ends half a
                          // milliradian above
  limits.upper = 0.9995;
  const Retimed retimed = Retime(path, {limits}, {false}, nullptr);
  EXPECT_GE(retimed.trajectory.positions.minCoeff(), limits.lower);
  EXPECT_LE(retimed.trajectory.positions.maxCoeff(), limits.upper);
  EXPECT_LE(retimed.deviations[0], 2e-3);
}

TEST(Retiming, SameInputSameMotion) {
  const RobotModel& model = Panda(true);
  const RetimedJoints joints = JointsToRetime(model);
  const RecordedPath path = MakeMotion(model, MotionKind::kPolicy, 2.0, 4);
  const Retimed a = Retime(path, joints.limits, joints.sliding, &model.arm);
  const Retimed b = Retime(path, joints.limits, joints.sliding, &model.arm);
  EXPECT_EQ(a.trajectory.positions, b.trajectory.positions);
  EXPECT_EQ(a.trajectory.accelerations, b.trajectory.accelerations);
}

void ExpectRefused(const RecordedPath& path, const RetimingOptions& options,
                   std::initializer_list<const char*> words) {
  try {
    Retime(path, {kJoint}, {false}, nullptr, options);
    ADD_FAILURE() << "not refused";
  } catch (const core::Error& error) {
    for (const char* word : words) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
}

TEST(Retiming, RefusesWhatCannotBeMade) {
  const RecordedPath whole = Cosine(1.0, 1.0);
  RecordedPath path = whole;
  path.positions(30, 0) = std::numeric_limits<double>::quiet_NaN();
  ExpectRefused(path, {}, {"'joint' at 0.5 s", "not finite"});
  path = whole;
  path.positions.array() += 1.5;
  ExpectRefused(path, {}, {"'joint' at", "outside its limits -2 to 2"});
  path = whole;
  path.positions(30, 0) += 0.3;
  ExpectRefused(path, {}, {"'joint' at 0.5 s", "jumps by 0.3", "0.2"});
  path = whole;
  std::swap(path.times[10], path.times[11]);
  ExpectRefused(path, {}, {"time of position 11", "evenly"});
  path = whole;
  for (std::size_t k = 40; k < path.times.size(); ++k) path.times[k] += 1.0;
  ExpectRefused(path, {}, {"time of position 40"});
  path = whole;
  path.times.resize(3);
  path.positions.conservativeResize(3, 1);
  ExpectRefused(path, {}, {"3 positions"});
  path.positions.conservativeResize(2, 1);
  ExpectRefused(path, {}, {"sizes of names"});
  RetimingOptions options;
  options.max_stretch = 1.0;
  ExpectRefused(Cosine(1.5, 0.4), options,
                {"'joint' at 0.2 s", "velocity 5.8", "limit is 2", "than 1 times"});
  options = {};
  options.ramp = 0.0;
  ExpectRefused(whole, options, {"ramp"});
}

}  // namespace
}  // namespace simwright::robot
