// CompactSolver against Bullet's own iterations: the same constraint rows, so the same motion up to
// rounding.
#include "sim/driven_robot.h"

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "geometry/mass_properties.h"
#include "robot/panda_model.h"

namespace simwright::sim {
namespace {

RigidBody CompactSolverCylinder() {
  RigidBody body;
  body.name = "cylinder";
  core::TriangleMesh mesh = assets::CylinderMesh(0.03, 0.1);
  const auto solid = geometry::SolidMassProperties(mesh, 700.0);
  body.parts = {mesh};
  body.inertial = {solid.mass, solid.center_of_mass, solid.inertia};
  body.friction = 0.6;
  body.rolling_friction = 5e-4;
  return body;
}

// A cylinder thrown along the floor with spin, so that it slides, rolls and spins; beside it a
// robot whose joints are driven, one into its limit.
struct Scene {
  explicit Scene(bool compact) : world(Options(compact)), robot(Robot(&world)) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(1.0, 0.0, 0.08);
    pose.linear() = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1.0, 0.3, 0.2).normalized()).matrix();
    object = world.Add(CompactSolverCylinder(), pose);
  }
  static WorldOptions Options(bool compact) {
    WorldOptions options;
    options.solver_iterations = 400;
    options.compact_solver = compact;
    return options;
  }
  static DrivenRobot Robot(ArticulatedWorld* world) {
    const robot::RobotModel& panda = robot::Panda(false);
    return DrivenRobot(panda, RobotBody(panda), Eigen::Isometry3d::Identity(), world);
  }
  void Step() {
    Eigen::VectorXd command = robot::Panda(false).home();
    command[0] += 0.4;
    command[3] = -4.0;  // past its limit of -3.07
    robot.Command(command, robot::Panda(false).gripper.closed);
    if (world.time() < 0.05) world.PushRoot(object, {3.0, 1.0, 0.0});
    robot.Drive();
    world.Step();
  }
  ArticulatedWorld world;
  DrivenRobot robot;
  int object = -1;
};

TEST(CompactSolver, MovesThingsAsBulletDoes) {
  Scene compact(true), bullet(false);
  double impulse = 0.0;
  for (int step = 0; step < 240; ++step) {
    compact.Step();
    bullet.Step();
    const Eigen::Isometry3d a = compact.world.LinkPose(compact.object, 0);
    const Eigen::Isometry3d b = bullet.world.LinkPose(bullet.object, 0);
    // It touches from step 19 on. Later rounding decides which of two corners touches first.
    if (step < 60) {
      ASSERT_LT((a.matrix() - b.matrix()).norm(), 1e-9) << step;
    }
    Eigen::VectorXd p, q;
    compact.robot.Positions(&p);
    bullet.robot.Positions(&q);
    ASSERT_LT((p - q).norm(), 1e-9) << step;
    for (const LinkContact& contact : compact.world.Contacts()) impulse += contact.impulse;
  }
  // It did rest on the floor: contacts carried its full weight.
  const double weight = CompactSolverCylinder().inertial.mass * 9.81;
  EXPECT_NEAR(impulse, weight * compact.world.time(), 0.25 * weight);
  EXPECT_GT((compact.world.LinkPose(compact.object, 0).translation().x()), 1.05);
}

// The same start gives the same bits.
TEST(CompactSolver, RepeatsItselfBitForBit) {
  Scene first(true), second(true);
  for (int step = 0; step < 240; ++step) {
    first.Step();
    second.Step();
  }
  const Eigen::Matrix4d a = first.world.LinkPose(first.object, 0).matrix();
  EXPECT_EQ(a, Eigen::Matrix4d(second.world.LinkPose(second.object, 0).matrix()));
}

}  // namespace
}  // namespace simwright::sim
