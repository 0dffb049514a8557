// The Panda under motors: it stands still, lifts a cup, and its fingers stay symmetric.
#include "sim/driven_robot.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "core/random.h"
#include "geometry/mass_properties.h"
#include "robot/inverse_kinematics.h"
#include "robot/panda_model.h"

namespace simwright::sim {
namespace {

using Eigen::Vector3d;

RigidBody DrivenRobotCylinder(double radius, double height, double mass) {
  RigidBody body;
  body.name = "cup";
  core::TriangleMesh mesh = assets::CylinderMesh(radius, height);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(0, 0, 0.5 * height)), &mesh);
  const auto unit = geometry::SolidMassProperties(mesh, 1.0);
  const auto solid = geometry::SolidMassProperties(mesh, mass / unit.mass);
  body.parts = {mesh};
  body.inertial = {solid.mass, solid.center_of_mass, solid.inertia};
  body.friction = 0.6;
  return body;
}

TEST(DrivenRobot, StandsStillUnderGravityForAMinute) {
  const robot::RobotModel& panda = robot::Panda(false);
  const auto body = RobotBody(panda);
  core::Rng rng(5);
  for (int configuration = 0; configuration < 3; ++configuration) {
    ArticulatedWorld world;
    DrivenRobot robot(panda, body, Eigen::Isometry3d::Identity(), &world);
    Eigen::VectorXd q = panda.home();
    for (Eigen::Index j = 0; j < q.size(); ++j) q[j] += core::Uniform(rng, -0.3, 0.3);
    robot.Place(q, panda.gripper.open);
    const Vector3d start = robot.Tool().translation();
    EXPECT_LT((start - robot::ForwardKinematics(panda.arm, q).translation()).norm(), 1e-9);
    double farthest = 0.0;
    while (world.time() < 60.0) {
      robot.Drive();
      world.Step();
      farthest = std::max(farthest, (robot.Tool().translation() - start).norm());
    }
    EXPECT_LT(farthest, 1e-3);
    EXPECT_LT(farthest, 1e-5);  // far better than required: the motors are solved, not tuned
  }
}

// Returns joint positions with the tool at `position`, pointing down.
Eigen::VectorXd Above(const robot::RobotModel& panda, const Vector3d& position) {
  core::Rng rng(1);
  robot::InverseKinematicsOptions options;
  options.position_tolerance = 1e-5;
  options.approach_tolerance = 1e-4;
  options.iterations = 200;
  const auto found = robot::SolveInverseKinematics(
      panda.arm, {position, Vector3d(-Vector3d::UnitZ())}, rng, options);
  EXPECT_TRUE(found.reached);
  return found.q;
}

// With the solver iterations of a check and with those of a training.
class DrivenRobotGrasp : public testing::TestWithParam<int> {};

TEST_P(DrivenRobotGrasp, LiftsACupByContactAloneAndHoldsIt) {
  const robot::RobotModel& panda = robot::Panda(false);
  WorldOptions options;
  options.solver_iterations = GetParam();
  ArticulatedWorld world(options);
  const int cup = world.Add(DrivenRobotCylinder(0.03, 0.1, 0.2),
                            Eigen::Isometry3d(Eigen::Translation3d(0.45, 0.1, 0.0)));
  DrivenRobot robot(panda, RobotBody(panda), Eigen::Isometry3d::Identity(), &world);
  const Eigen::VectorXd low = Above(panda, {0.45, 0.1, 0.085}),
                        high = Above(panda, {0.45, 0.1, 0.3});
  robot.Place(low, panda.gripper.open);
  const auto run = [&](double seconds, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                       double leader) {
    const double begin = world.time();
    while (world.time() < begin + seconds) {
      const double share = std::min(1.0, (world.time() - begin) / seconds);
      robot.Command(from + share * (to - from), leader);
      robot.Drive();
      world.Step();
    }
  };
  run(1.0, low, low, panda.gripper.closed);
  run(1.5, low, high, panda.gripper.closed);
  run(0.5, high, high, panda.gripper.closed);
  // The grasp point, 8.5 cm above the cup's base, in the tool frame.
  const auto in_tool = [&] {
    return Vector3d(robot.Tool().inverse() * world.LinkPose(cup, 0) * Vector3d(0, 0, 0.085));
  };
  const Vector3d held = in_tool();
  EXPECT_GT(world.LinkPose(cup, 0).translation().z(), 0.2);
  double slip = 0.0;
  const double begin = world.time();
  while (world.time() < begin + 10.0) {
    robot.Drive();
    world.Step();
    slip = std::max(slip, (in_tool() - held).norm());
  }
  EXPECT_LT(slip, 1e-3);
  // Both fingers press, at mirrored positions.
  double left = 0.0, right = 0.0;
  for (const LinkContact& contact : world.Contacts()) {
    const bool cup_first = contact.body_a == cup;
    const int other = cup_first ? contact.link_b : contact.link_a;
    if ((cup_first ? contact.body_b : contact.body_a) != robot.body()) continue;
    if (other == panda.gripper.links[0]) left += contact.impulse;
    if (other == panda.gripper.links[1]) right += contact.impulse;
  }
  const double force = panda.gripper.grip_force;
  EXPECT_NEAR(left / world.time_step(), force, 0.05 * force);
  EXPECT_NEAR(right / world.time_step(), force, 0.05 * force);
  EXPECT_NEAR(world.Position(robot.body(), panda.gripper.joints[0]),
              world.Position(robot.body(), panda.gripper.joints[1]), 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Iterations, DrivenRobotGrasp, testing::Values(50, 20));

// Returns the height (m) by which a cup of 0.2 kg is lifted after it was gripped with 20 N and
// raised by 0.2 m.
double Lifted(double finger_friction) {
  const robot::RobotModel& panda = robot::Panda(false);
  WorldOptions options;
  options.solver_iterations = 50;
  ArticulatedWorld world(options);
  const int cup = world.Add(DrivenRobotCylinder(0.03, 0.1, 0.2),
                            Eigen::Isometry3d(Eigen::Translation3d(0.45, 0.1, 0.0)));
  MotorOptions motors;
  motors.finger_friction = finger_friction;
  DrivenRobot robot(panda, RobotBody(panda), Eigen::Isometry3d::Identity(), &world, motors);
  const Eigen::VectorXd low = Above(panda, {0.45, 0.1, 0.085}),
                        high = Above(panda, {0.45, 0.1, 0.285});
  robot.Place(low, panda.gripper.open);
  while (world.time() < 4.0) {
    const double share = std::clamp((world.time() - 1.0) / 2.5, 0.0, 1.0);
    robot.Command(low + share * (high - low), panda.gripper.closed);
    robot.Drive();
    world.Step();
  }
  return world.LinkPose(cup, 0).translation().z();
}

// The cup weighs 1.96 N, two fingers press with 20 N each, the friction of a pair is the product of
// both, the cup's 0.6: fingers hold it from 1.96 / (2 x 20 x 0.6) = 0.082 on.
TEST(DrivenRobot, FingersHoldFromTheFrictionThatCoulombAsksFor) {
  EXPECT_LT(Lifted(0.05), 0.02);
  EXPECT_GT(Lifted(0.13), 0.18);
  EXPECT_GT(Lifted(2.0), 0.19);
}

TEST(DrivenRobot, FingersStayAPair) {
  const robot::RobotModel& panda = robot::Panda(false);
  ArticulatedWorld world;
  DrivenRobot robot(panda, RobotBody(panda), Eigen::Isometry3d::Identity(), &world);
  robot.Place(panda.home(), 0.02);
  for (int step = 0; step < 480; ++step) {
    robot.Drive();
    world.Push(robot.body(), panda.gripper.joints[1], step < 240 ? 10.0 : -10.0);
    world.Step();
    ASSERT_NEAR(world.Position(robot.body(), panda.gripper.joints[0]),
                world.Position(robot.body(), panda.gripper.joints[1]), 1e-3)
        << step;
  }
}

}  // namespace
}  // namespace simwright::sim
