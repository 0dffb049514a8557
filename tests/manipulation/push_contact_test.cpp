// The pushing pose for a door: behind it, along its motion, and only if it is to be shut.
#include "manipulation/push_contact.h"

#include <gtest/gtest.h>

#include "tests/skills/skill_scene.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

std::shared_ptr<const skills::Skill> SkillOf(const skills::SkillSubtask& scene) {
  return skills::MakeSkill(robot::Panda(false), {scene}, skills::SkillOptions().ForEvaluation());
}

// Returns a panel of `width` x 0.02 x 0.3 m on a vertical axis at its side, wide open at 1.5.
tasks::ArticulatedObject Panel(double width) {
  assets::SemanticModel model;
  model.name = "panel";
  assets::UrdfLink post = tasks::MakeLink("post", 1.0), leaf = tasks::MakeLink("leaf", 1.0);
  post.collisions = {tasks::Block({0.02, 0.02, 0.3}, {0, 0, 0.15})};
  leaf.collisions = {tasks::Block({width, 0.02, 0.3}, {0.5 * width, 0, 0.15})};
  model.model.links = {post, leaf};
  model.model.joints = {tasks::MakeJoint("hinge", "post", "leaf", assets::JointType::kRevolute,
                                         Vector3d::Zero(), {0, 0, 1}, 0.0, 1.5)};
  return tasks::MakeArticulatedObject("panel", model);
}

TEST(PushingPoses, AreBehindTheDoorAndGoItsWay) {
  const auto skill = SkillOf(skills::CloseDoor());
  const skills::SkillVariant& variant = skill->variants.front();
  const InteractionTarget& target = *variant.target;
  ASSERT_TRUE(target.pushes);
  const tasks::ArticulatedObject& object = variant.model.objects[0];
  ASSERT_EQ(target.approaches.size(), 3u);  // from above, past the edge, with the fingertips
  for (size_t i = 0; i < 2; ++i) {
    InteractionTarget one = target;
    one.link_from_grasp = target.approaches[i];
    tasks::WorldState state = variant.start;
    const Isometry3d before = GraspPoseAtJoint(variant.model, state, one);
    state.joints[0][static_cast<size_t>(target.joint)] -= 1e-6;
    const Isometry3d after = GraspPoseAtJoint(variant.model, state, one);
    const Vector3d displacement = (after.translation() - before.translation()).normalized();
    // The contact is slightly behind the face that contains the hinge: its motion is not quite
    // along x.
    EXPECT_GT(displacement.dot(before.linear().col(0)), 0.95);
    for (const Vector3d& point : object.links[static_cast<size_t>(target.link)].extreme_points) {
      EXPECT_GE((target.approaches[i].inverse() * point).x(), 0.02 - 1e-9);
    }
    EXPECT_NEAR(target.approaches[i].linear().determinant(), 1.0, 1e-12);
  }
  EXPECT_LT(GraspPoseAtJoint(variant.model, variant.start, target).linear()(2, 2), -0.999);
}

TEST(PushingPoses, ToHighEdgesAreNotFromAbove) {
  tasks::WorldModel model;
  model.objects = {Panel(0.4)};
  tasks::WorldState state;
  state.roots = {Isometry3d::Identity()};
  state.joints = {{1.2}};
  const tasks::ObjectJoint& hinge = model.objects[0].joints[0];
  const auto low = PushingPoses(model, state, 0, hinge, 0.0);
  ASSERT_EQ(low.size(), 3u);
  EXPECT_NEAR(low[0].translation().z(), 0.27, 1e-9);  // 3 cm below the edge
  EXPECT_NEAR(low[0].translation().x(), 0.3, 1e-9);   // three quarters of the way out
  EXPECT_NEAR(low[1].translation().z(), 0.15, 1e-9);
  EXPECT_NEAR(low[1].translation().x(), 0.37, 1e-9);
  // It shuts clockwise: the gripper is on the side of positive y.
  EXPECT_NEAR(low[1].translation().y(), 0.03, 1e-9);
  // From a base 30 cm lower it is a face from 0.3 to 0.6 m: 0.4 m up is within it.
  const auto high = PushingPoses(model, state, 0, hinge, -0.3);
  ASSERT_EQ(high.size(), 2u);
  EXPECT_NEAR(high[0].translation().z(), 0.1, 1e-9);
}

TEST(SampleStart, AHandThatBeginsAtTheDoorDoesNotGoBackFirst) {
  skills::SkillOptions options;
  options.at_target_share = 1.0;
  options.partly_open_share = 0.0;
  const auto skill = skills::MakeSkill(robot::Panda(false), {skills::CloseDoor()}, options);
  core::Rng rng = core::StreamRng(3, 0);
  int grasp_configuration = 0;
  for (int i = 0; i < 10; ++i) {
    const skills::StartState start = skills::SampleStart(*skill, rng);
    const bool there = start.arm == start.grasp_configuration;
    grasp_configuration += there;
    EXPECT_EQ(start.waypoints.empty(), there);
  }
  EXPECT_GT(grasp_configuration, 0);
}

TEST(IsClosedByPushing, IsNoKnobAndNothingThatIsOpened) {
  const tasks::ArticulatedObject door = Panel(0.4), knob = Panel(0.06);
  EXPECT_TRUE(IsClosedByPushing(door, door.joints[0], 1.2));
  EXPECT_FALSE(IsClosedByPushing(door, door.joints[0], 0.0));
  EXPECT_FALSE(IsClosedByPushing(knob, knob.joints[0], 1.2));
  EXPECT_FALSE(SkillOf(skills::OpenDoor())->variants.front().target->pushes);
}

}  // namespace
}  // namespace simwright::manipulation
