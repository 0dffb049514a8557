// Durations of retimed motions: against the optimum without jerk limits, and against the recording
// if its pace is kept.
#include <gtest/gtest.h>

#include "robot/limit_check.h"
#include "robot/panda_model.h"
#include "robot/path_speed.h"
#include "robot/retiming.h"
#include "tests/robot/path_optimum.h"
#include "tests/robot/recorded_motions.h"

namespace simwright::robot {
namespace {

// One joint over 1 rad from rest to rest, 10 rad/s^2 and 2 rad/s: 0.2 s up, 0.3 s, 0.2 s down.
TEST(LeastSeconds, IsTheTrapezoidOfOneJoint) {
  Eigen::MatrixXd rows(2001, 1);
  for (int i = 0; i <= 2000; ++i) rows(i, 0) = i / 2000.0;
  EXPECT_NEAR(LeastSeconds(rows, 1.0 / 2000.0, {{-2, 2, 2, 10, 1e4, 0}}), 0.7, 1e-3);
}

TEST(MaxPathSpeeds, AreTheTrapezoidsOfOneJoint) {
  PathDerivatives path;
  path.step = 0.001;
  path.first = Eigen::MatrixXd::Ones(1, 1001);
  path.second = path.third = Eigen::MatrixXd::Zero(1, 1001);
  const std::vector<JointLimits> limits = {{-2, 2, 2, 10, 1e4, 0}};
  const std::vector<double> most(1001, 50.0);
  // The speed at the end is bounded by velocity only, as no point follows.
  const std::vector<double> speeds = MaxPathSpeeds(path, limits, most);
  for (const double speed : speeds) EXPECT_NEAR(speed, 2.0, 1e-9);
  // A point that must be passed at 0.5 /s: v^2 = 0.25 + 2 a s on both sides.
  path.first(0, 500) = 4.0;
  const std::vector<double> slowed = MaxPathSpeeds(path, limits, most);
  EXPECT_NEAR(slowed[500], 0.5, 1e-9);
  EXPECT_NEAR(slowed[450], std::sqrt(0.25 + 20.0 * 0.05), 0.02);
  EXPECT_NEAR(slowed[550], std::sqrt(0.25 + 20.0 * 0.05), 0.02);
}

struct Pace {
  MotionKind kind;
  double most;  // times the optimum
};

class AtTheLimits : public testing::TestWithParam<Pace> {};

// The same path through its own positions, at the limits of velocity and acceleration only.
TEST_P(AtTheLimits, TakesLittleMoreThanTheOptimumWithoutJerk) {
  const RobotModel& model = Panda(false);
  const RetimedJoints joints = JointsToRetime(model);
  RetimingOptions options;
  options.max_speed_up = 100.0;
  for (std::uint64_t seed = 30; seed < 33; ++seed) {
    const RecordedPath path = MakeMotion(model, GetParam().kind, 4.0, seed);
    const Retimed retimed = Retime(path, joints.limits, joints.sliding, &model.arm, options);
    EXPECT_TRUE(CheckLimits(retimed.trajectory, joints.limits).accepted());
    double step = 0.0;
    const Eigen::MatrixXd rows = AlongTheWay(retimed.trajectory, joints.sliding, 3000, &step);
    const double seconds = retimed.trajectory.times.back();
    const double least = LeastSeconds(rows, step, joints.limits);
    EXPECT_LT(seconds, GetParam().most * least) << seed;
    EXPECT_GT(seconds, 0.9 * least) << seed;  // otherwise the optimum is not one
    RecordProperty("ratio_" + std::to_string(seed), std::to_string(seconds / least));
  }
}

INSTANTIATE_TEST_SUITE_P(Motions, AtTheLimits,
                         testing::Values(Pace{MotionKind::kSmooth, 1.05},
                                         Pace{MotionKind::kFast, 1.05},
                                         Pace{MotionKind::kNoisy, 1.05},
                                         Pace{MotionKind::kPolicy, 1.12},
                                         Pace{MotionKind::kCorners, 1.12}));

// One joint from rest to rest: jerk-limited ramps of acceleration, then of velocity. Over a way
// that reaches acceleration and velocity, the least duration is way / v + v / a + a / j.
TEST(Retiming, OneJointTakesLittleMoreThanTheLeastDurationWithJerk) {
  const double way = 1.0;
  for (const double jerk : {100.0, 1000.0, 10000.0}) {
    for (const double recorded : {0.8, 3.0}) {  // s: too fast, and slower than the limits
      RecordedPath path;
      path.joints = {"joint"};
      const auto count = static_cast<Eigen::Index>(std::lround(recorded * 60.0)) + 1;
      path.positions.resize(count, 1);
      for (Eigen::Index k = 0; k < count; ++k) {
        path.times.push_back(static_cast<double>(k) / 60.0);
        path.positions(k, 0) =
            0.5 * way * (1.0 - std::cos(std::numbers::pi * path.times.back() / recorded));
      }
      const std::vector<JointLimits> limits = {{-2, 2, 2, 10, jerk, 0}};
      RetimingOptions options;
      options.max_speed_up = 100.0;
      const Retimed retimed = Retime(path, limits, {false}, nullptr, options);
      const double least = way / 2.0 + 2.0 / 10.0 + 10.0 / jerk;
      const double seconds = retimed.trajectory.times.back();
      EXPECT_TRUE(CheckLimits(retimed.trajectory, limits).accepted());
      // The rounded corners of the path's first and last milliradians are free.
      EXPECT_GT(seconds, 0.995 * least) << jerk << " " << recorded;
      EXPECT_LT(seconds, 1.1 * least) << jerk << " " << recorded;
      RecordProperty("ratio_" + std::to_string(jerk) + "_" + std::to_string(recorded),
                     std::to_string(seconds / least));
    }
  }
}

// Both searches end in local optima, if limits slow the motion down: the optimum of the wider bound
// must not be the worse one.
TEST(Retiming, AnySpeedIsNotSlowerThanTheRecordedOne) {
  const RobotModel& model = Panda(true);
  const RetimedJoints joints = JointsToRetime(model);
  for (const MotionKind kind : {MotionKind::kSmooth, MotionKind::kPolicy, MotionKind::kCorners}) {
    const RecordedPath path = MakeMotion(model, kind, 0.7, 1000);
    RetimingOptions options;
    const auto seconds = [&] {
      return Retime(path, joints.limits, joints.sliding, &model.arm, options)
          .trajectory.times.back();
    };
    const double recorded = seconds();
    options.max_speed_up = 100.0;
    EXPECT_LE(seconds(), recorded + 2e-3);
  }
}

// Rests take no time unless the pace is kept.
TEST(Retiming, KeepsThePaceWhereItIsAsked) {
  RecordedPath path;
  path.joints = {"joint"};
  path.positions.resize(181, 1);
  for (Eigen::Index k = 0; k <= 180; ++k) {
    path.times.push_back(static_cast<double>(k) / 60.0);
    // 0.1 rad in a second, a rest of a second, and back.
    const double t = path.times.back();
    const double way = 0.05 * (1.0 - std::cos(std::numbers::pi * std::min(t, 1.0)));
    const double back = 0.05 * (1.0 - std::cos(std::numbers::pi * std::max(t - 2.0, 0.0)));
    path.positions(k, 0) = way - back;
  }
  const std::vector<JointLimits> limits = {{-2, 2, 2, 10, 5000, 0}};
  RetimingOptions options;
  options.max_speed_up = 100.0;
  // Twice 0.1 rad at 10 rad/s^2 takes 0.2 s, and each of four halts some hundredths.
  EXPECT_LT(Retime(path, limits, {false}, nullptr, options).trajectory.times.back(), 0.62);
  path.speed_ups.assign(181, 100.0);
  for (Eigen::Index k = 60; k <= 120; ++k) path.speed_ups[static_cast<std::size_t>(k)] = 1.0;
  const Retimed kept = Retime(path, limits, {false}, nullptr, options);
  EXPECT_GE(kept.waypoint_times[120] - kept.waypoint_times[60], 0.999);
  EXPECT_LT(kept.trajectory.times.back(), 1.75);
}

}  // namespace
}  // namespace simwright::robot
