// Links on fixed joints that are merged into their carrier: the same motion as unmerged, and each
// keeps its own pose, shape and name in contacts.
#include <gtest/gtest.h>

#include <cmath>

#include "assets/primitive_meshes.h"
#include "robot/panda_model.h"
#include "sim/driven_robot.h"

namespace simwright::sim {
namespace {

using Eigen::Vector3d;

RigidBody LinkTreeBox(const std::string& name, const Vector3d& size, double mass) {
  RigidBody body;
  body.name = name;
  body.parts = {assets::BoxMesh(size)};
  const Vector3d s = size.cwiseProduct(size);
  body.inertial.mass = mass;
  body.inertial.inertia =
      Vector3d(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()).asDiagonal() * (mass / 12.0);
  return body;
}

assets::Joint Joint(assets::JointType type, const Vector3d& origin, double turn) {
  assets::Joint joint;
  joint.type = type;
  joint.axis = Vector3d::UnitY();
  joint.lower = -3.0;
  joint.upper = 3.0;
  joint.parent_from_joint.translation() = origin;
  joint.parent_from_joint.linear() = Eigen::AngleAxisd(turn, Vector3d::UnitX()).toRotationMatrix();
  return joint;
}

// Returns a body in which joints[i] connects links[i] to links[i + 1].
ArticulatedBody ChainOf(const std::string& name, const std::vector<RigidBody>& links,
                        std::vector<assets::Joint> joints) {
  std::vector<assets::KinematicLink> tree;
  for (const RigidBody& link : links) tree.push_back({link.name, link.inertial});
  for (size_t i = 0; i < joints.size(); ++i) {
    joints[i].name = "joint_" + std::to_string(i);
    joints[i].parent = links[i].name;
    joints[i].child = links[i + 1].name;
  }
  return {std::make_shared<assets::KinematicModel>(name, tree, joints), links};
}

// Returns a rod on a hinge, a plate fixed to its end at an angle, a frame without mass or shape
// fixed to that, and a second rod on a hinge from the frame.
ArticulatedBody Chain() {
  RigidBody frame;
  frame.name = "frame";
  using Type = assets::JointType;
  return ChainOf(
      "chain",
      {LinkTreeBox("base", {0.1, 0.1, 0.1}, 1.0), LinkTreeBox("rod", {0.3, 0.04, 0.04}, 0.7),
       LinkTreeBox("plate", {0.1, 0.1, 0.01}, 0.4), frame,
       LinkTreeBox("end", {0.2, 0.02, 0.02}, 0.2)},
      {Joint(Type::kRevolute, {0.2, 0.0, 0.0}, 0.0), Joint(Type::kFixed, {0.2, 0.03, 0.02}, 0.5),
       Joint(Type::kFixed, {0.05, 0.0, 0.01}, -0.2),
       Joint(Type::kRevolute, {0.15, 0.0, 0.0}, 0.3)});
}

TEST(LinkTree, FoldedLinksMoveAsTheyDoApart) {
  const ArticulatedBody chain = Chain();
  ArticulatedWorld folded, apart;
  Placement placement;
  placement.contacts = false;
  folded.Add(chain, placement);
  placement.self_contacts = true;
  apart.Add(chain, placement);
  EXPECT_NEAR(folded.LoadedInertial(0, 1).mass, 1.1, 1e-12);
  EXPECT_EQ(folded.LoadedInertial(0, 2).mass, 0.0);
  EXPECT_NEAR(apart.LoadedInertial(0, 1).mass, 0.7, 1e-12);
  double moved = 0.0;
  for (int step = 0; step < 240; ++step) {
    for (ArticulatedWorld* world : {&folded, &apart}) {
      world->Push(0, 3, 0.05);
      world->Step();
    }
    for (int link = 0; link < 5; ++link) {
      const Eigen::Matrix4d a = folded.LinkPose(0, link).matrix();
      const Eigen::Matrix4d b = apart.LinkPose(0, link).matrix();
      ASSERT_LT((a - b).norm(), 1e-9) << step << ' ' << link;
    }
    EXPECT_NEAR(folded.Velocity(0, 3), apart.Velocity(0, 3), 1e-8);
    moved = std::max(moved, std::abs(folded.Position(0, 0)));
  }
  EXPECT_GT(moved, 0.1);
}

// A plate fixed beside a heavy base: an object on it touches the plate, at the plate's height and
// with the plate's friction.
TEST(LinkTree, ContactsNameTheFoldedLink) {
  const ArticulatedBody shelf = ChainOf(
      "shelf",
      {LinkTreeBox("base", {0.1, 0.1, 0.4}, 5.0), LinkTreeBox("plate", {0.3, 0.3, 0.02}, 1.0)},
      {Joint(assets::JointType::kFixed, {0.4, 0.0, 0.1}, 0.0)});
  ArticulatedWorld world;
  Placement placement;
  placement.world_from_root.translation() = Vector3d(0.0, 0.0, 0.2);
  world.Add(shelf, placement);
  const int box = world.Add(LinkTreeBox("box", {0.1, 0.1, 0.1}, 0.5),
                            Eigen::Isometry3d(Eigen::Translation3d(0.4, 0.0, 0.362)));
  while (world.time() < 1.0) world.Step();
  EXPECT_NEAR(world.LinkPose(box, 0).translation().z(), 0.3 + 0.01 + 0.05, 3e-4);
  EXPECT_LT((world.LinkPose(0, 1).translation() - Vector3d(0.4, 0.0, 0.3)).norm(), 1e-9);
  double impulse = 0.0;
  for (const LinkContact& contact : world.Contacts()) {
    const bool shelf_first = contact.body_a == 0;
    EXPECT_EQ(shelf_first ? contact.link_a : contact.link_b, 1);
    impulse += contact.impulse;
  }
  EXPECT_NEAR(impulse, 0.5 * 9.81 / 240.0, 1e-4);
}

// The gripper, its tool frame and the flange agree with the arm's kinematics.
TEST(LinkTree, ThePandasToolIsWhereItsKinematicsSay) {
  const robot::RobotModel& panda = robot::Panda(false);
  ArticulatedWorld world;
  DrivenRobot robot(panda, RobotBody(panda), Eigen::Isometry3d::Identity(), &world);
  Eigen::VectorXd goal = panda.home(), now;
  goal.array() += 0.2;
  robot.Command(goal, panda.gripper.open);
  for (int step = 0; step < 60; ++step) {
    robot.Drive();
    world.Step();
    robot.Positions(&now);
    const Eigen::Isometry3d tool = robot::ForwardKinematics(panda.arm, now);
    ASSERT_LT((tool.matrix() - robot.Tool().matrix()).norm(), 1e-9) << step;
  }
}

}  // namespace
}  // namespace simwright::sim
