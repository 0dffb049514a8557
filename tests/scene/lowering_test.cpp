// Lowering of floating bodies, against closed forms.
#include "scene/feasibility/lowering.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/scene/convex_parts.h"

namespace simwright::scene {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::ConvexShape;

struct LoweringArticulatedObject {
  std::vector<ConvexShape> parts;
  Vector3d place;
  bool fixed = false;
};

std::vector<Vector3d> Lower(const std::vector<LoweringArticulatedObject>& objects, double most) {
  std::vector<ProjectedBody> bodies;
  for (const LoweringArticulatedObject& object : objects) {
    Isometry3d pose = Isometry3d::Identity();
    pose.translation() = object.place;
    bodies.push_back({&object.parts, pose, object.fixed});
  }
  return LowerOntoSupports(bodies, most);
}

// Its top is at 0.5.
LoweringArticulatedObject Table() {
  return {{Box({1.0, 1.0, 0.1})}, {0, 0, 0.45}, true};
}

TEST(LowerOntoSupports, AStackComesDownInOrder) {
  const auto shifts = Lower({Table(),
                             {{Box({0.1, 0.1, 0.1})}, {0, 0, 0.72}},     // 0.17 above the table
                             {{Box({0.1, 0.1, 0.1})}, {0.01, 0, 0.58}},  // 0.03 above it
                             {{Box({0.1, 0.1, 0.1})}, {0.3, 0, 0.55}}},  // on it
                            0.1);
  EXPECT_EQ(shifts[0], Vector3d::Zero());
  EXPECT_NEAR(shifts[2].z(), -0.03, 2e-5);
  EXPECT_NEAR(shifts[1].z(), -0.07, 3e-5);  // onto the other, which has been lowered
  EXPECT_NEAR(shifts[3].z(), 0.0, 2e-5);
  for (const Vector3d& shift : shifts) EXPECT_EQ(shift.head<2>().norm(), 0.0);
}

TEST(LowerOntoSupports, BallsMeetAsideOfTheirTops) {
  const double aside = 0.06, apart = 0.1;  // of the balls' middles where they touch: 0.06, 0.08
  const auto shifts =
      Lower({{{Ball(0.06)}, {0, 0, 0.06}, true}, {{Ball(0.04)}, {aside, 0, 0.2}}}, 0.2);
  EXPECT_NEAR(shifts[1].z(), -(0.2 - 0.06 - std::sqrt(apart * apart - aside * aside)), 2e-5);
}

TEST(LowerOntoSupports, WhatMeetsNothingStays) {
  const auto shifts =
      Lower({Table(),
             {{Box({0.1, 0.1, 0.1})}, {0, 0, 0.66}},     // 0.11 above the table
             {{Box({0.1, 0.1, 0.1})}, {0.8, 0, 0.55}},   // beside it, 0.5 above the floor
             {{Box({0.1, 0.1, 0.1})}, {0.8, 1, 0.14}}},  // 0.09 above the floor
            0.1);
  EXPECT_EQ(shifts[1], Vector3d::Zero());
  EXPECT_EQ(shifts[2], Vector3d::Zero());
  EXPECT_NEAR(shifts[3].z(), -0.09, 1e-12);
}

// Between walls that touch it, onto the bottom of a hollow body.
TEST(LowerOntoSupports, WallsDoNotHold) {
  const LoweringArticulatedObject hollow{
      {Box({0.02, 0.1, 0.1}, {-0.06, 0, 0.05}), Box({0.02, 0.1, 0.1}, {0.06, 0, 0.05}),
       Box({0.1, 0.1, 0.01}, {0, 0, 0.005})},
      {0, 0, 0.5},
      true};
  const auto shifts = Lower({hollow, {{Box({0.1, 0.05, 0.04})}, {0, 0, 0.6}}}, 0.1);
  EXPECT_NEAR(shifts[1].z(), -(0.58 - 0.51), 2e-5);
}

TEST(LowerOntoSupports, RefusesWhatMakesNoSense) {
  EXPECT_TRUE(Lower({}, 0.1).empty());
  EXPECT_THROW(Lower({Table()}, -0.1), core::Error);
  EXPECT_THROW(Lower({Table()}, NAN), core::Error);
  EXPECT_THROW(Lower({{{Ball(0.1)}, {0, 0, NAN}}}, 0.1), core::Error);
}

}  // namespace
}  // namespace simwright::scene
