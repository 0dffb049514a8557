// The grasp of a knob's bar, against the dimensions of bar and stem.
#include "manipulation/outer_section_grasp.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/tasks/household.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kTip = 0.0095;  // m, the Panda's

// Returns a tool that points down at a height of `z` (m); its closing axis is `turn` (rad) off x.
Isometry3d FromAbove(double z, double turn) {
  Isometry3d tool = Isometry3d::Identity();
  tool.linear() << Vector3d::UnitY(), Vector3d::UnitX(), -Vector3d::UnitZ();
  tool.rotate(Eigen::AngleAxisd(turn, Vector3d::UnitZ()));
  tool.translation().z() = z;
  return tool;
}

// Returns a stem of 20 x 20 x 14 mm below a bar of 14 x 52 mm and the given height.
std::vector<core::TriangleMesh> Knob(double bar_height) {
  return {tasks::Block({0.02, 0.02, 0.014}, {0.0, 0.0, 0.007}).mesh,
          tasks::Block({0.014, 0.052, bar_height}, {0.0, 0.0, 0.014 + 0.5 * bar_height}).mesh};
}

core::TriangleMesh Prism(int corners, double radius, double height) {
  core::TriangleMesh mesh;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    for (const double z : {0.0, height}) {
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  for (int i = 0; i < corners; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % corners);
    mesh.triangles.emplace_back(a, b, b + 1);
    mesh.triangles.emplace_back(a, b + 1, a + 1);
    if (i == 0) continue;
    mesh.triangles.emplace_back(0, b, a);
    mesh.triangles.emplace_back(1, a + 1, b + 1);
  }
  return mesh;
}

TEST(GraspOfOuterSection, HoldsTheBarOfAKnobAndNotItsStem) {
  const Isometry3d tool = GraspOfOuterSection(Knob(0.014), FromAbove(0.014, 0.17), kTip);
  EXPECT_LT(std::abs(tool.linear().col(1).y()), std::sin(0.01));  // across the bar's thin side
  EXPECT_EQ(tool.linear().col(2), Vector3d(-Vector3d::UnitZ()));
  const double lowest = tool.translation().z() - kTip;  // of the pads
  EXPECT_GE(lowest, 0.014);
  EXPECT_LT(lowest, 0.0151);
}

TEST(GraspOfOuterSection, LeavesAGraspOfARoundPart) {
  const Isometry3d given = FromAbove(0.01, 0.3);
  EXPECT_TRUE(GraspOfOuterSection({Prism(96, 0.015, 0.03)}, given, kTip).isApprox(given, 1e-12));
}

TEST(GraspOfOuterSection, LeavesABarThatIsTooLowForThePads) {
  const Isometry3d tool = GraspOfOuterSection(Knob(0.005), FromAbove(0.0095, 0.0), kTip);
  EXPECT_NEAR(tool.translation().z(), 0.0095, 1e-12);
}

}  // namespace
}  // namespace simwright::manipulation
