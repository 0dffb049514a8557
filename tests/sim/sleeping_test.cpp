// Bodies that sleep in a world against bodies that never do.
#include <limits>

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "geometry/mass_properties.h"
#include "robot/panda_model.h"
#include "sim/articulated_world.h"
#include "sim/driven_robot.h"

namespace simwright::sim {
namespace {

RigidBody SleepingTestBox(const Eigen::Vector3d& size) {
  RigidBody body;
  body.name = "box";
  const core::TriangleMesh mesh = assets::BoxMesh(size);
  const auto solid = geometry::SolidMassProperties(mesh, 400.0);
  body.parts = {mesh};
  body.inertial = {solid.mass, solid.center_of_mass, solid.inertia};
  body.friction = 0.5;
  return body;
}

WorldOptions SleepingTestOptions(bool sleeping) {
  WorldOptions options;
  options.solver_iterations = 20;
  options.sleeping = sleeping;
  return options;
}

Eigen::Isometry3d At(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

// Two boxes of a stack come to rest where they do without sleep, and then do not move by a bit.
TEST(Sleeping, KeepsAStackWhereItRests) {
  Eigen::Matrix4d poses[2][2];
  for (const bool sleeping : {false, true}) {
    ArticulatedWorld world(SleepingTestOptions(sleeping));
    const int lower = world.Add(SleepingTestBox({0.1, 0.1, 0.05}), At(0, 0, 0.026));
    const int upper = world.Add(SleepingTestBox({0.06, 0.06, 0.04}), At(0.01, 0, 0.073));
    for (int step = 0; step < 480; ++step) world.Step();
    for (const int body : {lower, upper}) {
      poses[sleeping][body] = world.LinkPose(body, 0).matrix();
    }
    for (int step = 0; step < 240; ++step) world.Step();
    if (!sleeping) continue;
    EXPECT_EQ(poses[1][0], Eigen::Matrix4d(world.LinkPose(lower, 0).matrix()));
    EXPECT_EQ(poses[1][1], Eigen::Matrix4d(world.LinkPose(upper, 0).matrix()));
    EXPECT_EQ(world.Contacts().size(), 8u);  // they stay known
  }
  for (const int body : {0, 1}) {
    EXPECT_LT((poses[0][body] - poses[1][body]).norm(), 1e-4);
  }
}

// A box that slides into another wakes it: the second moves as it does without sleep.
TEST(Sleeping, EndsBeforeACollision) {
  double travelled[2];
  for (const bool sleeping : {false, true}) {
    ArticulatedWorld world(SleepingTestOptions(sleeping));
    const int box = world.Add(SleepingTestBox({0.05, 0.05, 0.05}), At(0, 0, 0.026));
    const int ram = world.Add(SleepingTestBox({0.05, 0.05, 0.05}), At(-0.6, 0, 0.026));
    for (int step = 0; step < 240; ++step) world.Step();
    const double start = world.LinkPose(box, 0).translation().x();
    world.SetRootVelocity(ram, {3.0, 0, 0}, {0, 0, 0});
    for (int step = 0; step < 480; ++step) world.Step();
    travelled[sleeping] = world.LinkPose(box, 0).translation().x() - start;
    EXPECT_LT(world.LinkPose(ram, 0).translation().x(), world.LinkPose(box, 0).translation().x());
  }
  EXPECT_GT(travelled[0], 0.02);
  EXPECT_NEAR(travelled[1], travelled[0], 0.02 * travelled[0]);
}

// A box on a floor that is tilted (by gravity) until it slides wakes and slides: v^2 = 2 a s.
TEST(Sleeping, EndsWhenGravityTurns) {
  ArticulatedWorld world(SleepingTestOptions(true));
  const int box = world.Add(SleepingTestBox({0.1, 0.1, 0.04}), At(0, 0, 0.021));
  for (int step = 0; step < 240; ++step) world.Step();
  const double start = world.LinkPose(box, 0).translation().x();
  world.SetGravity({8.0, 0.0, -9.81});
  for (int step = 0; step < 120; ++step) world.Step();
  const double acceleration = 8.0 - 0.5 * 9.81;
  EXPECT_NEAR(world.LinkPose(box, 0).translation().x() - start, 0.5 * acceleration * 0.25, 0.01);
}

// A box on another falls when the other is taken away.
TEST(Sleeping, EndsWhenTheSupportIsMoved) {
  ArticulatedWorld world(SleepingTestOptions(true));
  Placement fixed;
  fixed.world_from_root = At(0, 0, 0.1);
  const int shelf = world.Add(ArticulatedBodyFrom(SleepingTestBox({0.2, 0.2, 0.02})), fixed);
  const int box = world.Add(SleepingTestBox({0.05, 0.05, 0.05}), At(0, 0, 0.136));
  for (int step = 0; step < 240; ++step) world.Step();
  EXPECT_GT(world.LinkPose(box, 0).translation().z(), 0.13);
  world.SetRootPose(shelf, At(1.0, 0, 0.1));
  for (int step = 0; step < 240; ++step) world.Step();
  EXPECT_LT(world.LinkPose(box, 0).translation().z(), 0.03);
}

// A state that is not finite shows in the poses instead of the last finite ones.
TEST(Sleeping, HidesNoFailure) {
  ArticulatedWorld world(SleepingTestOptions(true));
  const int box = world.Add(SleepingTestBox({0.05, 0.05, 0.05}), At(0, 0, 0.5));
  world.Step();
  world.SetRootVelocity(box, {std::numeric_limits<double>::quiet_NaN(), 0, 0}, {0, 0, 0});
  world.Step();
  EXPECT_FALSE(world.LinkPose(box, 0).matrix().allFinite());
}

// A robot that has held still for seconds keeps what it holds awake: bit by bit the same as without
// sleep.
TEST(Sleeping, ExemptsWhatARobotHolds) {
  const robot::RobotModel& panda = robot::Panda(false);
  Eigen::Matrix4d poses[2];
  for (const bool sleeping : {false, true}) {
    ArticulatedWorld world(SleepingTestOptions(sleeping));
    DrivenRobot robot(panda, RobotBody(panda), Eigen::Isometry3d::Identity(), &world);
    const Eigen::Isometry3d held(Eigen::Translation3d(robot.Tool().translation()));
    const int box = world.Add(SleepingTestBox({0.04, 0.04, 0.04}), held);
    robot.Command(panda.home(), panda.gripper.closed);
    for (int step = 0; step < 720; ++step) {
      robot.Drive();
      if (step < 120) world.SetRootPose(box, held);
      world.Step();
    }
    poses[sleeping] = world.LinkPose(box, 0).matrix();
    EXPECT_LT((poses[sleeping].block<3, 1>(0, 3) - held.translation()).norm(), 3e-3);
  }
  EXPECT_EQ(poses[0], poses[1]);
}

}  // namespace
}  // namespace simwright::sim
