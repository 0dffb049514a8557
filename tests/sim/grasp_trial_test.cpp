// Grasp trials of a parallel-jaw gripper against closed forms, in both engines.
#include "sim/grasp_trial.h"

#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "geometry/mass_properties.h"
#include "tests/sim/plain_gripper.h"

namespace simwright::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

RigidBody GraspTrialBody(const Vector3d& size, double mass) {
  RigidBody body;
  body.name = "box";
  body.parts = {BoxAround({0, 0, 0.5 * size.z()}, size)};
  const auto unit = geometry::SolidMassProperties(body.parts[0], 1.0);
  const auto solid = geometry::SolidMassProperties(body.parts[0], mass / unit.mass);
  body.inertial = {solid.mass, solid.center_of_mass, solid.inertia};
  return body;
}

// A grasp from above at the centre of mass.
GraspTrialInput FromAbove(double height) {
  GraspTrialInput input;
  input.object_from_tool.linear() =
      Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX()).toRotationMatrix();
  input.object_from_tool.translation() = Vector3d(0, 0, height);
  input.opening = 0.06;
  return input;
}

class GraspTrialTest : public testing::TestWithParam<GraspEngine> {};

// Two fingers of force F hold m g if 2 mu F >= m g; at rest, without the accelerations of a lift.
TEST_P(GraspTrialTest, HoldsUpToTheFrictionLimit) {
  const double friction = 0.2, mass = 1.0, gravity = 9.81;
  const double limit = mass * gravity / (2.0 * friction);  // 24.5 N
  GraspTrialOptions options;
  options.friction = friction;
  options.shake = false;
  options.lift_height = 0.0;
  for (const double share : {0.4, 0.9, 1.1, 1.25}) {
    const GraspTrials trials(GetParam(), PlainGripper(share * limit),
                             GraspTrialBody({0.04, 0.04, 0.06}, mass), options);
    const GraspTrialResult result = trials.Run(FromAbove(0.03));
    EXPECT_TRUE(result.closed) << result.reason;
    EXPECT_EQ(result.held, share > 1.0) << share << ": " << result.reason;
    // A box that slips turns between the fingers.
    EXPECT_NEAR(result.width, 0.04, share > 1.0 ? 5e-4 : 1e-3);
  }
}

TEST_P(GraspTrialTest, LiftsShakesHoldsAndReleases) {
  GraspTrialOptions options;
  options.release = true;
  const GraspTrials trials(GetParam(), PlainGripper(30.0), GraspTrialBody({0.04, 0.04, 0.06}, 0.3),
                           options);
  for (const bool floor : {false, true}) {
    GraspTrialInput input = FromAbove(0.035);
    if (floor) input.world_from_object = Isometry3d::Identity();
    const GraspTrialResult result = trials.Run(input);
    EXPECT_TRUE(result.held) << result.reason;
    EXPECT_TRUE(result.released) << result.reason;
    EXPECT_LT(result.shake.distance, 2e-3);
    EXPECT_LT(result.hold.distance, 5e-4);
    EXPECT_LT(result.penetration, 1e-3);
  }
}

TEST_P(GraspTrialTest, SaysWhyAGraspFails) {
  const GripperModel gripper = PlainGripper(30.0);
  const RigidBody box = GraspTrialBody({0.04, 0.04, 0.06}, 0.3);
  const GraspTrials trials(GetParam(), gripper, box);
  GraspTrialInput input = FromAbove(0.10);  // the fingertips end 1 cm above it
  EXPECT_EQ(trials.Run(input).reason, "the fingers close beside it");
  input = FromAbove(0.03);
  input.opening = 0.02;
  EXPECT_EQ(trials.Run(input).reason, "the open gripper is in it");
  input = FromAbove(-0.05);
  input.world_from_object = Isometry3d::Identity();
  EXPECT_EQ(trials.Run(input).reason, "the gripper is in the floor");
  input.opening = 0.09;
  EXPECT_THROW(trials.Run(input), core::Error);
}

// A rod that is held at its end turns about the closing axis: between pads of 2 x 4 cm, friction
// resists a moment of about mu F times the pads' mean radius, which is far less than m g l / 2.
TEST_P(GraspTrialTest, ALongRodTurnsInTheFingers) {
  RigidBody rod = GraspTrialBody({0.6, 0.02, 0.02}, 0.6);
  GraspTrialOptions options;
  options.friction = 0.3;
  options.shake = false;
  const GraspTrials trials(GetParam(), PlainGripper(30.0), rod, options);
  GraspTrialInput input = FromAbove(0.01);
  EXPECT_TRUE(trials.Run(input).held) << trials.Run(input).reason;
  input.object_from_tool.translation().x() = 0.28;
  const GraspTrialResult end = trials.Run(input);
  EXPECT_TRUE(end.closed);
  EXPECT_FALSE(end.held);
  EXPECT_GT(end.lift.angle, 0.3);
}

TEST_P(GraspTrialTest, RepeatsToTheBit) {
  const GraspTrials trials(GetParam(), PlainGripper(30.0), GraspTrialBody({0.04, 0.04, 0.06}, 0.3));
  const GraspTrialResult first = trials.Run(FromAbove(0.045));
  trials.Run(FromAbove(0.02));
  const GraspTrialResult again = trials.Run(FromAbove(0.045));
  EXPECT_EQ(first.shake.distance, again.shake.distance);
  EXPECT_EQ(first.hold.angle, again.hold.angle);
}

INSTANTIATE_TEST_SUITE_P(Engines, GraspTrialTest,
                         testing::Values(GraspEngine::kBullet, GraspEngine::kMujoco));

}  // namespace
}  // namespace simwright::sim
