// Limits along a path against derivatives by the chain rule.
#include "robot/path_limits.h"

#include <gtest/gtest.h>

#include <cmath>

namespace simwright::robot {
namespace {

// At slowness 2 with derivatives 1 and 0.5 the parameter has the rates 1/2, -1/8 and 1/16. A joint
// with derivatives 3, 1 and -2 along the path then moves at 3/2, accelerates by 1/4 - 3/8 = -1/8,
// and has the jerk -1/4 - 3/16 + 3/16 = -1/4.
class PathLimitsOfOneJoint : public testing::Test {
 protected:
  PathLimitsOfOneJoint() {
    path_.step = 1.0;
    path_.first = Eigen::MatrixXd::Constant(1, 1, 3.0);
    path_.second = Eigen::MatrixXd::Constant(1, 1, 1.0);
    path_.third = Eigen::MatrixXd::Constant(1, 1, -2.0);
  }
  double Excess(double velocity, double acceleration, double jerk, double share) const {
    return PathLimits(path_, {{-9, 9, velocity, acceleration, jerk, 0}})
        .Excess(0, kSlowness, share);
  }

  static constexpr TimeLaw::Slowness kSlowness = {2.0, 1.0, 0.5};
  PathDerivatives path_;
};

TEST_F(PathLimitsOfOneJoint, AreReachedByTheValuesOfTheChainRule) {
  EXPECT_NEAR(Excess(1.5, 10.0, 10.0, 1.0), 1.0, 1e-12);
  EXPECT_NEAR(Excess(10.0, 0.125, 10.0, 1.0), 1.0, 1e-12);
  EXPECT_NEAR(Excess(10.0, 10.0, 0.25, 1.0), 1.0, 1e-12);
  EXPECT_LT(Excess(1.6, 0.13, 0.26, 1.0), 1.0);
}

// Velocity falls with a uniform slowness, acceleration with its square, jerk with its cube.
TEST_F(PathLimitsOfOneJoint, AreExceededByTheFactorOfAUniformSlowness) {
  EXPECT_NEAR(Excess(1.5, 10.0, 10.0, 0.5), 2.0, 1e-12);
  EXPECT_NEAR(Excess(10.0, 0.125, 10.0, 0.5), std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(Excess(10.0, 10.0, 0.25 / 8.0, 1.0), 2.0, 1e-12);
  const PathLimits limits(path_, {{-9, 9, 1.5, 10, 10, 0}});
  EXPECT_FALSE(limits.Hold(0, kSlowness, 0.5));
  EXPECT_TRUE(limits.Hold(0, {4.0, 2.0, 1.0}, 0.5));
}

}  // namespace
}  // namespace simwright::robot
