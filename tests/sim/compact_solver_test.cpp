// CompactSolver against Bullet's own dynamics and solver: the same constraints, so the same motion
// up to rounding.
#include "sim/driven_robot.h"

#include <cmath>

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "geometry/mass_properties.h"
#include "robot/panda_model.h"

namespace simwright::sim {
namespace {

WorldOptions CompactSolverOptions(bool compact, int iterations) {
  WorldOptions options;
  options.solver_iterations = iterations;
  options.compact_solver = compact;
  return options;
}

RigidBody CompactSolverCylinder() {
  RigidBody body;
  body.name = "cylinder";
  core::TriangleMesh mesh = assets::CylinderMesh(0.03, 0.1);
  // Irregular: among the corners of a regular one rounding decides which touches first.
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    const double k = static_cast<double>(i);
    mesh.vertices[i] += 3e-4 * Eigen::Vector3d(std::sin(k), std::sin(2.0 * k), std::sin(3.0 * k));
  }
  const auto solid = geometry::SolidMassProperties(mesh, 700.0);
  body.parts = {mesh};
  body.inertial = {solid.mass, solid.center_of_mass, solid.inertia};
  body.friction = 0.6;
  body.rolling_friction = 5e-4;
  return body;
}

// A cylinder thrown along the floor with spin, so that it slides, rolls and spins.
struct ThrownCylinder {
  explicit ThrownCylinder(bool compact) : world(CompactSolverOptions(compact, 20)) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(1.0, 0.0, 0.08);
    pose.linear() = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1.0, 0.3, 0.2).normalized()).matrix();
    object = world.Add(CompactSolverCylinder(), pose);
  }
  void Step() {
    if (world.time() < 0.05) world.PushRoot(object, {3.0, 1.0, 0.0});
    world.Step();
  }
  Eigen::Matrix4d Pose() const { return world.LinkPose(object, 0).matrix(); }
  ArticulatedWorld world;
  int object = -1;
};

TEST(CompactSolver, MovesThingsAsBulletDoes) {
  ThrownCylinder compact(true), bullet(false);
  double impulse = 0.0;
  for (int step = 0; step < 240; ++step) {
    compact.Step();
    bullet.Step();
    // It touches from step 19 on; the collisions let differences grow.
    ASSERT_LT((compact.Pose() - bullet.Pose()).norm(), step < 60 ? 1e-9 : 1e-6) << step;
    for (const LinkContact& contact : compact.world.Contacts()) impulse += contact.impulse;
  }
  // It did rest on the floor: contacts carried its full weight.
  const double weight = CompactSolverCylinder().inertial.mass * 9.81;
  EXPECT_NEAR(impulse, weight * compact.world.time(), 0.25 * weight);
  EXPECT_GT(compact.Pose()(0, 3), 1.05);
}

// A robot whose joints are driven, one into its limit, and whose fingers are geared. Bullet solves
// the joints in another order: the iterations have to converge.
TEST(CompactSolver, MovesRobotsAsBulletDoes) {
  const robot::RobotModel& panda = robot::Panda(false);
  ArticulatedWorld worlds[] = {ArticulatedWorld(CompactSolverOptions(true, 400)),
                               ArticulatedWorld(CompactSolverOptions(false, 400))};
  std::vector<DrivenRobot> robots;
  for (ArticulatedWorld& world : worlds) {
    robots.emplace_back(panda, RobotBody(panda), Eigen::Isometry3d::Identity(), &world);
  }
  Eigen::VectorXd command = panda.home(), positions[2], velocities[2];
  command[0] += 0.4;
  command[3] = -4.0;  // past its limit of -3.07
  for (int step = 0; step < 240; ++step) {
    for (size_t i = 0; i < 2; ++i) {
      robots[i].Command(command, panda.gripper.closed);
      robots[i].Drive();
      worlds[i].Step();
      robots[i].Positions(&positions[i]);
      robots[i].Velocities(&velocities[i]);
    }
    ASSERT_LT((positions[0] - positions[1]).norm(), 1e-9) << step;
    ASSERT_LT((velocities[0] - velocities[1]).norm(), 1e-7) << step;
    ASSERT_NEAR(robots[0].Leader(), robots[1].Leader(), 1e-9) << step;
  }
  EXPECT_NEAR(positions[0][0], command[0], 1e-3);
  EXPECT_NEAR(positions[0][3], -3.07, 0.01);
}

// The same start gives the same bits.
TEST(CompactSolver, RepeatsItselfBitForBit) {
  ThrownCylinder first(true), second(true);
  for (int step = 0; step < 240; ++step) {
    first.Step();
    second.Step();
  }
  EXPECT_EQ(first.Pose(), second.Pose());
}

}  // namespace
}  // namespace simwright::sim
