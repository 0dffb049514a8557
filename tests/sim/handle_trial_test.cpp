// Trials of grasps at handles against closed forms, in both engines.
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "geometry/mass_properties.h"
#include "sim/grasp_trial.h"
#include "tests/sim/plain_gripper.h"

namespace simwright::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

RigidBody HandleLink(const std::string& name, const core::TriangleMesh& part, double mass) {
  RigidBody link;
  link.name = name;
  link.parts = {part};
  const auto unit = geometry::SolidMassProperties(part, 1.0);
  const auto solid = geometry::SolidMassProperties(part, mass / unit.mass);
  link.inertial = {solid.mass, solid.center_of_mass, solid.inertia};
  return link;
}

assets::Joint HandleJoint(const std::string& name, const std::string& parent,
                          const std::string& child, assets::JointType type,
                          const Vector3d& parent_from_joint) {
  assets::Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.child = child;
  joint.type = type;
  joint.parent_from_joint = Isometry3d(Eigen::Translation3d(parent_from_joint));
  return joint;
}

GraspedPart PartOf(std::vector<RigidBody> links, std::vector<assets::Joint> joints, double far) {
  GraspedPart part;
  std::vector<assets::KinematicLink> tree;
  for (const RigidBody& link : links) tree.push_back({link.name, link.inertial});
  part.body.kinematics =
      std::make_shared<assets::KinematicModel>("cabinet", tree, std::move(joints));
  part.body.links = std::move(links);
  part.link = 2;
  part.joint = 0;
  part.far = far;
  return part;
}

// A drawer of 2 kg in a cabinet, which slides towards -x, and its bar, 12 mm high and 5 cm in
// front.
GraspedPart Drawer(double friction, double damping = 0.0) {
  assets::Joint slide =
      HandleJoint("slide", "body", "drawer", assets::JointType::kPrismatic, {-0.2, 0.0, 0.5});
  slide.axis = Vector3d(-1, 0, 0);
  slide.upper = 0.3;
  slide.friction = friction;
  slide.damping = damping;
  const assets::Joint weld =
      HandleJoint("weld", "drawer", "handle", assets::JointType::kFixed, {-0.06, 0.0, 0.0});
  return PartOf({HandleLink("body", BoxAround({0.1, 0, 0.5}, {0.4, 0.4, 1.0}), 20.0),
                 HandleLink("drawer", BoxAround({0, 0, 0}, {0.02, 0.35, 0.2}), 2.0),
                 HandleLink("handle", BoxAround({0, 0, 0}, {0.012, 0.12, 0.012}), 0.1)},
                {slide, weld}, 0.3);
}

// A grasp of the bar from the front, along +x; the fingers close along z.
GraspTrialInput FromFront() {
  GraspTrialInput input;
  input.object_from_tool.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  input.opening = 0.032;
  return input;
}

class HandleTrialTest : public testing::TestWithParam<GraspEngine> {};

// Two fingers of force F pull a drawer if 2 mu F exceeds the joint's friction and what accelerates
// the drawer: at most m a with a = (pi / T)^2 s / 2 on a cosine profile of s metres in T seconds.
TEST_P(HandleTrialTest, PullsADrawerUpToTheFrictionLimit) {
  const double friction = 0.4, force = 30.0;
  const double limit = 2.0 * friction * force;  // 24 N
  const double acceleration = 0.5 * std::pow(std::numbers::pi / 2.0, 2) * 0.8 * 0.3;
  GraspTrialOptions options;
  options.friction = friction;
  options.hold_time = 0.3;
  for (const double share : {0.1, 0.9, 1.1, 1.5}) {
    const GraspTrials trials(GetParam(), PlainGripper(force),
                             Drawer(share * limit - 2.1 * acceleration), options);
    const GraspTrialResult result = trials.Run(FromFront());
    EXPECT_TRUE(result.closed) << result.reason;
    EXPECT_NEAR(result.width, 0.012, 5e-4);
    EXPECT_EQ(result.held, share < 1.0) << share << ": " << result.reason;
    if (share < 1.0) {
      EXPECT_NEAR(result.joint_share, 0.8, 0.01);
      EXPECT_LT(result.joint_motion.distance, 2e-3);
    } else {
      EXPECT_EQ(result.reason.substr(0, 7), "slipped") << result.reason;
    }
  }
}

// At constant c, the damper takes c v, with the peak v = (pi / 2) s / T.
TEST_P(HandleTrialTest, PullsAgainstTheDamperUpToTheFrictionLimit) {
  GraspTrialOptions options;
  options.friction = 0.4;
  options.hold_time = 0.3;
  const double limit = 24.0, fastest = 0.5 * std::numbers::pi * 0.8 * 0.3 / 2.0;
  for (const double share : {0.85, 1.5}) {
    const GraspTrials trials(GetParam(), PlainGripper(30.0), Drawer(0.0, share * limit / fastest),
                             options);
    const GraspTrialResult result = trials.Run(FromFront());
    EXPECT_EQ(result.held, share < 1.0) << share << ": " << result.reason;
  }
}

// A finger that is off the middle by 5 mm touches first, and the arm yields to it.
TEST_P(HandleTrialTest, TheArmYieldsToAFingerThatTouchesFirst) {
  const GraspTrials trials(GetParam(), PlainGripper(30.0), Drawer(5.0));
  for (const double offset : {-0.006, 0.006}) {
    GraspTrialInput input = FromFront();
    input.object_from_tool.translation().z() = offset;
    const GraspTrialResult result = trials.Run(input);
    EXPECT_TRUE(result.held) << result.reason;
    EXPECT_NEAR(result.width, 0.012, 5e-4);
  }
}

// A door of 80 cm about a vertical axis: the palm follows an arc of 0.8 x 90 degrees.
TEST_P(HandleTrialTest, OpensADoorOnItsArc) {
  assets::Joint hinge =
      HandleJoint("hinge", "body", "door", assets::JointType::kRevolute, {0, 0.4, 0.5});
  hinge.axis = Vector3d(0, 0, 1);
  hinge.lower = -0.5 * std::numbers::pi;
  hinge.friction = 0.5;
  const assets::Joint weld =
      HandleJoint("weld", "door", "handle", assets::JointType::kFixed, {-0.06, -0.7, 0.0});
  const GraspedPart part =
      PartOf({HandleLink("body", BoxAround({0.2, 0, 0.5}, {0.3, 0.8, 1.0}), 20.0),
              HandleLink("door", BoxAround({0, -0.4, 0}, {0.02, 0.8, 0.9}), 6.0),
              HandleLink("handle", BoxAround({0, 0, 0}, {0.012, 0.012, 0.12}), 0.1)},
             {hinge, weld}, hinge.lower);
  const GraspTrials trials(GetParam(), PlainGripper(30.0), part);
  GraspTrialInput input;
  input.object_from_tool.linear() << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  input.opening = 0.032;
  const GraspTrialResult result = trials.Run(input);
  EXPECT_TRUE(result.held) << result.reason;
  EXPECT_NEAR(result.joint_share, 0.8, 0.01);
  EXPECT_LT(result.joint_motion.angle, 0.1);
  const GraspTrialResult again = trials.Run(input);
  EXPECT_EQ(result.joint_share, again.joint_share);
}

TEST_P(HandleTrialTest, RefusesPartsThatNoJointMoves) {
  GraspedPart part = Drawer(1.0);
  part.far = 0.0;
  EXPECT_THROW(GraspTrials(GetParam(), PlainGripper(30.0), part), core::Error);
  part = Drawer(1.0);
  part.joint = 1;  // fixed
  EXPECT_THROW(GraspTrials(GetParam(), PlainGripper(30.0), part), core::Error);
  part = Drawer(1.0);
  part.link = 0;
  EXPECT_THROW(GraspTrials(GetParam(), PlainGripper(30.0), part), core::Error);
  const GraspTrials trials(GetParam(), PlainGripper(30.0), Drawer(1.0));
  GraspTrialInput input = FromFront();
  input.world_from_object = Isometry3d::Identity();
  EXPECT_THROW(trials.Run(input), core::Error);
}

INSTANTIATE_TEST_SUITE_P(Engines, HandleTrialTest,
                         testing::Values(GraspEngine::kBullet, GraspEngine::kMujoco));

}  // namespace
}  // namespace simwright::sim
