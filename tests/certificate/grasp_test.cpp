// Grasps, goals, collisions and bases against closed forms.
#include "certificate/grasp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "certificate/goal.h"
#include "certificate/planner.h"
#include "certificate/robot_base.h"
#include "certificate/robot_clearance.h"
#include "certificate_scene.h"
#include "robot/panda_model.h"

namespace simwright::certificate {
namespace {

TEST(Grasps, OfABoxSpanItsSidesWithinTheFrictionCone) {
  const auto box = BoxModel({0.05, 0.12, 0.06});
  const std::vector<Grasp> grasps = SampleGrasps(*box, robot::Panda(false), 3);
  ASSERT_GT(grasps.size(), 20u);
  for (const Grasp& grasp : grasps) {
    const Eigen::Vector3d axis = grasp.body_from_tool.linear().col(1);
    // Across x (0.05 m) or z (0.06 m); the sides in y are wider than the gripper. Along a line at
    // an angle to the normal the width grows by its cosine.
    const bool across_x = std::abs(axis.x()) > 0.9, across_z = std::abs(axis.z()) > 0.9;
    EXPECT_TRUE(across_x || across_z) << axis.transpose();
    const double side = across_x ? 0.05 / std::abs(axis.x()) : 0.06 / std::abs(axis.z());
    EXPECT_NEAR(grasp.width, side, 1e-9);
    EXPECT_GE(std::max(std::abs(axis.x()), std::abs(axis.z())), std::cos(0.35) - 1e-9);
    EXPECT_NEAR(grasp.body_from_tool.linear().determinant(), 1.0, 1e-9);
    EXPECT_GE(2.0 * grasp.leader, grasp.width + 0.004 - 1e-9);
  }
}

TEST(Grasps, AreDeterministicAndNoneFitsAWideBody) {
  const auto can = ModelOf(assets::CylinderMesh(0.03, 0.1, 32), 0.1);
  const auto first = SampleGrasps(*can, robot::Panda(false), 5);
  const auto second = SampleGrasps(*can, robot::Panda(false), 5);
  ASSERT_EQ(first.size(), second.size());
  for (size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].body_from_tool.matrix(), second[i].body_from_tool.matrix());
  }
  EXPECT_TRUE(SampleGrasps(*BoxModel({0.1, 0.1, 0.1}), robot::Panda(false), 5).empty());
}

TEST(RobotClearance, AgreesWithTheDistanceToAPlate) {
  // A vertical plate in front of the robot at home: the foremost point of the robot's shapes is
  // found by moving the plate.
  const RobotShapes shapes(robot::Panda(false));
  const robot::RobotModel& panda = robot::Panda(false);
  double foremost = 0.0;
  const auto poses = panda.LinkPoses(panda.home(), panda.gripper.open);
  for (size_t i = 0; i < shapes.links.size(); ++i) {
    for (const geometry::ConvexShape& shape : shapes.links[i]) {
      for (const Eigen::Vector3d& vertex : shape.vertices) {
        foremost = std::max(foremost, (poses[i] * vertex).x() + shape.radius);
      }
    }
  }
  EXPECT_GT(foremost, 0.3);
  const ClearanceMargins margins;
  for (const double gap : {0.0005, 0.006}) {
    PlacedScene scene;
    Put("plate", BoxModel({0.02, 3.0, 3.0}), {foremost + gap + 0.01, 0.0, 0.0}, &scene, true);
    const Obstacles obstacles(scene);
    RobotClearance clearance(shapes, obstacles, Eigen::Isometry3d::Identity(), margins);
    EXPECT_EQ(clearance.Hit(panda.home()), gap < margins.gripper ? 0 : kFree) << gap;
  }
}

TEST(RobotClearance, KeepsTheArmFromFloorAndItself) {
  const RobotShapes shapes(robot::Panda(false));
  const Obstacles none{PlacedScene()};
  const RobotClearance clearance(shapes, none, Eigen::Isometry3d::Identity(), {});
  robot::JointVector q = robot::Panda(false).home();
  EXPECT_EQ(clearance.Hit(q), kFree);
  q[1] = 1.7;  // leans forward and down
  q[3] = -0.3;
  EXPECT_EQ(clearance.Hit(q), kHitsFloor);
  q = robot::Panda(false).home();
  q[1] = 0.0;
  q[3] = -3.0;  // folds the forearm onto the upper arm
  q[5] = 0.2;
  EXPECT_EQ(clearance.Hit(q), kHitsItself);
}

TEST(Goals, OfShelvesAndTables) {
  PlacedScene scene = TableWithApple();
  EXPECT_FALSE(IsShelf(scene.bodies[0]));
  EXPECT_EQ(SupportOf(scene, kApple), 0);
  const auto table = FrontGoal(scene, kApple);
  ASSERT_TRUE(table);
  for (const Eigen::Isometry3d& place : table->places) {
    EXPECT_LT(place.translation().x(), 0.15);
    EXPECT_GT(place.translation().x() - 0.03, 0.0);  // the whole apple stands on the table
    EXPECT_NEAR(place.translation().z(), 0.337, 1e-6);
  }
  // Two boards, 0.3 m apart.
  sim::RigidBody shelf;
  for (const double z : {0.01, 0.31}) {
    core::TriangleMesh board = assets::BoxMesh({0.4, 0.6, 0.02});
    core::Transform(Eigen::Affine3d(Eigen::Translation3d(0.0, 0.0, z)), &board);
    shelf.parts.push_back(board);
  }
  shelf.inertial.mass = 1.0;
  shelf.inertial.inertia = Eigen::Matrix3d::Identity();
  PlacedScene shelves;
  Put("shelf", std::make_shared<const BodyModel>(shelf), {0.2, 0.0, 0.0}, &shelves, true);
  Put("apple", ModelOf(assets::CylinderMesh(0.03, 0.07), 0.15), {0.2, 0.0, 0.055}, &shelves);
  EXPECT_TRUE(IsShelf(shelves.bodies[0]));
  const auto front = FrontGoal(shelves, kApple);
  ASSERT_TRUE(front);
  EXPECT_EQ(front->kind, GoalKind::kInFront);
  EXPECT_NEAR(front->front, 0.0, 1e-12);
  const PlacedBody& apple = shelves.bodies[kApple];
  Eigen::Isometry3d now = apple.world_from_body;
  now.translation().x() = -0.029;
  EXPECT_FALSE(front->IsReached(*apple.model, apple.world_from_body, now));
  now.translation().x() = -0.031;
  EXPECT_TRUE(front->IsReached(*apple.model, apple.world_from_body, now));
}

TEST(RobotBase, IsInFrontOfTheFurnitureAndDoesNotDependOnObjects) {
  const Planner planner(robot::Panda(false));
  PlacedScene scene = TableWithApple();
  const RobotBase base = ChooseRobotBase(planner, scene, 0);
  EXPECT_LT(base.world_from_robot.translation().x(), -0.1);
  EXPECT_GT(base.reached, base.asked / 4);
  Put("box", BoxModel({0.2, 0.2, 0.2}), {0.3, 0.2, 0.4}, &scene);
  EXPECT_EQ(ChooseRobotBase(planner, scene, 0).world_from_robot.matrix(),
            base.world_from_robot.matrix());
}

}  // namespace
}  // namespace simwright::certificate
