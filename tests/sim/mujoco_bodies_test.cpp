// The same bodies in both engines: resting bodies stay in place, and a driven arm arrives where
// Bullet's does.
#include "sim/mujoco_bodies.h"

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "geometry/mass_properties.h"
#include "robot/panda_model.h"
#include "sim/driven_robot.h"

namespace simwright::sim {
namespace {

TEST(MujocoBodies, AnArmGetsToWhereItIsSent) {
  const robot::RobotModel& panda = robot::Panda(false);
  const auto arm = RobotBody(panda);
  RigidBody box;
  box.name = "box";
  box.parts = {assets::BoxMesh({0.1, 0.1, 0.1})};
  box.inertial = {0.5, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity() * 0.5 * 0.01 / 6.0};
  const ArticulatedBody object = ArticulatedBodyFrom(box);
  MujocoPlacement robot{&arm->body()}, standing{&object};
  for (const auto& limits : panda.limits) robot.motor_forces.push_back(limits.effort);
  standing.fixed = false;
  standing.world_from_root.translation() = Eigen::Vector3d(1.0, 0.0, 0.05);
  MujocoBodies mujoco({robot, standing}, 1.0 / 240.0);
  ArticulatedWorld world;
  DrivenRobot driven(panda, arm, Eigen::Isometry3d::Identity(), &world);
  Eigen::VectorXd goal = panda.home();
  goal[0] += 0.3;
  goal[3] += 0.2;
  driven.Command(goal, panda.gripper.open);
  for (size_t j = 0; j < panda.arm_joints.size(); ++j) {
    const auto index = static_cast<Eigen::Index>(j);
    mujoco.SetPosition(0, panda.arm_joints[j], panda.home()[index]);
    mujoco.Hold(0, panda.arm_joints[j], goal[index]);
  }
  for (int step = 0; step < 720; ++step) {
    driven.Drive();
    world.Step();
    mujoco.Step();
  }
  // MuJoCo's motors are springs: under the arm's weight, up to 40 N m, they yield by 0.03 rad.
  const Eigen::Isometry3d tool = mujoco.LinkPose(0, panda.tool_link);
  EXPECT_LT((tool.translation() - driven.Tool().translation()).norm(), 0.03);
  EXPECT_NEAR(mujoco.Position(0, panda.arm_joints[0]), goal[0], 1e-3);
  EXPECT_LT((mujoco.LinkPose(1, 0).translation() - Eigen::Vector3d(1.0, 0.0, 0.05)).norm(), 1e-3);
  EXPECT_EQ(mujoco.ContactCount(), 4);
}

}  // namespace
}  // namespace simwright::sim
