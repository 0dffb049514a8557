#include "robot/limit_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "core/error.h"

namespace simwright::robot {
namespace {

using Motion = std::function<Eigen::Vector3d(double)>;  // position, velocity, acceleration at t

JointTrajectory SampledAt1Khz(const std::vector<Motion>& joints, double seconds) {
  JointTrajectory trajectory;
  const auto count = static_cast<Eigen::Index>(std::llround(seconds * 1000.0)) + 1;
  for (Eigen::MatrixXd* matrix :
       {&trajectory.positions, &trajectory.velocities, &trajectory.accelerations}) {
    matrix->resize(count, static_cast<Eigen::Index>(joints.size()));
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    trajectory.joints.push_back("joint" + std::to_string(j + 1));
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Vector3d state = joints[j](static_cast<double>(i) / 1000.0);
      const auto column = static_cast<Eigen::Index>(j);
      trajectory.positions(i, column) = state[0];
      trajectory.velocities(i, column) = state[1];
      trajectory.accelerations(i, column) = state[2];
    }
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    trajectory.times.push_back(static_cast<double>(i) / 1000.0);
  }
  return trajectory;
}

Motion Sine(double size, double frequency) {
  return [=](double t) {
    const double s = std::sin(frequency * t), c = std::cos(frequency * t);
    return Eigen::Vector3d(size * s, size * frequency * c, -size * frequency * frequency * s);
  };
}

// Returns the minimum-jerk motion between rests over `distance` d in `seconds` T:
// d (10 x^3 - 15 x^4 + 6 x^5). Its largest velocity is 15/8 d/T, acceleration 10/sqrt(3) d/T^2,
// jerk 60 d/T^3.
Motion LeastJerk(double distance, double seconds) {
  return [=](double t) {
    const double x = t / seconds, T = seconds;
    return Eigen::Vector3d(distance * x * x * x * (10 + x * (6 * x - 15)),
                           distance / T * 30 * x * x * (1 + x * (x - 2)),
                           distance / (T * T) * 60 * x * (1 + x * (2 * x - 3)));
  };
}

const JointLimits kWide = {-10, 10, 100, 1000, 100000, 50};

std::set<std::string> Codes(const LimitReport& report) {
  std::set<std::string> codes;
  for (const core::Finding& finding : report.findings) codes.insert(finding.code);
  return codes;
}

TEST(LimitCheck, FindsTheMaximaOfASine) {
  constexpr double kSize = 0.7, kFrequency = 3.0;
  const JointTrajectory trajectory = SampledAt1Khz({Sine(kSize, kFrequency)}, 4.0);
  const LimitReport report = CheckLimits(trajectory, {kWide});
  const JointLimitReport& joint = report.joints[0];
  EXPECT_NEAR(std::abs(joint.position.value), kSize, 1e-6);
  EXPECT_NEAR(joint.position.ratio, kSize / 10.0, 1e-6);
  EXPECT_NEAR(std::abs(joint.velocity.value), kSize * kFrequency, 1e-6);
  EXPECT_NEAR(std::abs(joint.acceleration.value), kSize * std::pow(kFrequency, 2), 1e-5);
  EXPECT_NEAR(std::abs(joint.jerk.value), kSize * std::pow(kFrequency, 3), 1e-3);
  EXPECT_NEAR(joint.velocity.ratio, kSize * kFrequency / 100.0, 1e-8);
  // Position and acceleration peak where the sine does, velocity where it crosses zero.
  EXPECT_NEAR(std::abs(std::sin(kFrequency * joint.position.time)), 1.0, 1e-5);
  EXPECT_NEAR(std::abs(std::cos(kFrequency * joint.velocity.time)), 1.0, 1e-5);
  EXPECT_EQ(Codes(report), std::set<std::string>{"no-rest"});  // it starts at full speed
}

TEST(LimitCheck, DrawsTheLineAtTheLimit) {
  constexpr double kWay = 1.2, kSeconds = 1.5;
  const JointTrajectory trajectory =
      SampledAt1Khz({LeastJerk(kWay, kSeconds), LeastJerk(-0.1, kSeconds)}, kSeconds);
  const double velocity = 15.0 / 8.0 * kWay / kSeconds;
  const double acceleration = 10.0 / std::sqrt(3.0) * kWay / std::pow(kSeconds, 2);
  const double jerk = 60.0 * kWay / std::pow(kSeconds, 3);
  struct Case {
    double JointLimits::*limit;
    double peak;
    const char* code;
  };
  const Case cases[] = {{&JointLimits::upper, kWay, "limit-position"},
                        {&JointLimits::velocity, velocity, "limit-velocity"},
                        {&JointLimits::acceleration, acceleration, "limit-acceleration"},
                        {&JointLimits::jerk, jerk, "limit-jerk"}};
  for (const Case& c : cases) {
    JointLimits limits = kWide;
    limits.lower = -0.5;
    limits.*c.limit = c.peak * 1.0001;
    EXPECT_TRUE(CheckLimits(trajectory, {limits, kWide}).accepted()) << c.code;
    limits.*c.limit = c.peak * 0.99;
    const LimitReport report = CheckLimits(trajectory, {limits, kWide});
    EXPECT_EQ(Codes(report), std::set<std::string>{c.code});
    ASSERT_EQ(report.findings.size(), 1u);
    EXPECT_NE(report.findings[0].place.find("'joint1'"), std::string::npos);
    EXPECT_NEAR(std::abs(report.findings[0].figure), c.peak, 0.003 * c.peak);
  }
}

// For any disturbed sample, the check names its joint and its time.
TEST(LimitCheck, FindsADisturbedSample) {
  const JointTrajectory whole = SampledAt1Khz({LeastJerk(0.5, 1.0), LeastJerk(-0.5, 1.0)}, 1.0);
  const std::vector<JointLimits> limits(2, {-2, 2, 2, 10, 100, 50});
  ASSERT_TRUE(CheckLimits(whole, limits).accepted());
  for (const Eigen::Index at : {1, 250, 500, 998}) {
    for (const Eigen::Index joint : {0, 1}) {
      JointTrajectory bent = whole;
      bent.positions(at, joint) += 1e-5;  // rad: a jerk of 3 * 1e-5 / (1 ms)^3
      LimitReport report = CheckLimits(bent, limits);
      EXPECT_TRUE(Codes(report).contains("limit-jerk"));
      EXPECT_TRUE(Codes(report).contains("velocity-mismatch"));
      EXPECT_NEAR(report.joints[joint].jerk.time, static_cast<double>(at) / 1000.0, 2.1e-3);
      EXPECT_LT(report.joints[1 - joint].jerk.ratio, 1.0);

      bent = whole;
      bent.velocities(at, joint) += 1e-3;
      EXPECT_TRUE(Codes(CheckLimits(bent, limits)).contains("velocity-mismatch"));

      bent = whole;
      bent.accelerations(at, joint) += 0.2;
      report = CheckLimits(bent, limits);
      EXPECT_TRUE(Codes(report).contains("limit-jerk"));
      EXPECT_TRUE(Codes(report).contains("acceleration-mismatch"));
    }
  }
}

TEST(LimitCheck, VelocitiesOfAnotherMotionDoNotPass) {
  JointTrajectory trajectory = SampledAt1Khz({LeastJerk(0.5, 1.0)}, 1.0);
  trajectory.velocities *= 0.98;
  trajectory.accelerations *= 0.98;
  EXPECT_EQ(Codes(CheckLimits(trajectory, {{-2, 2, 2, 10, 100, 0}})),
            std::set<std::string>{"velocity-mismatch"});
}

TEST(LimitCheck, KnowsEffortsAndRest) {
  JointTrajectory trajectory = SampledAt1Khz({LeastJerk(0.5, 1.0)}, 1.0);
  trajectory.efforts = Eigen::MatrixXd::Constant(trajectory.size(), 1, 20.0);
  trajectory.efforts(700, 0) = -51.0;
  const LimitReport report = CheckLimits(trajectory, {kWide});
  EXPECT_EQ(Codes(report), std::set<std::string>{"limit-effort"});
  EXPECT_DOUBLE_EQ(report.joints[0].effort.time, 0.7);
  const JointTrajectory half = SampledAt1Khz({LeastJerk(0.5, 1.0)}, 0.5);
  EXPECT_EQ(Codes(CheckLimits(half, {kWide})), std::set<std::string>{"no-rest"});
}

TEST(LimitCheck, RefusesWhatIsNotWhole) {
  const JointTrajectory whole = SampledAt1Khz({LeastJerk(0.5, 1.0)}, 1.0);
  EXPECT_THROW(CheckLimits(whole, {}), core::Error);
  JointTrajectory broken = whole;
  broken.velocities.resize(0, 0);
  EXPECT_THROW(CheckLimits(broken, {kWide}), core::Error);
  broken = whole;
  broken.positions(3, 0) = std::nan("");
  EXPECT_THROW(CheckLimits(broken, {kWide}), core::Error);
  broken = whole;
  std::swap(broken.times[3], broken.times[4]);
  EXPECT_THROW(CheckLimits(broken, {kWide}), core::Error);
  broken = whole;
  broken.accelerations.conservativeResize(10, 1);
  EXPECT_THROW(CheckLimits(broken, {kWide}), core::Error);
}

}  // namespace
}  // namespace simwright::robot
