// The observed geometry of the target part, against finite differences of the joint's own motion
// and the shapes of the test scenes.
#include "manipulation/target_geometry.h"

#include <gtest/gtest.h>

#include "skills/skill_environment.h"
#include "tests/skills/skill_scene.h"

namespace simwright::manipulation {
namespace {

using Eigen::Vector3d;

skills::SkillSubtask OpenDrawer() {
  skills::SkillSubtask scene = skills::OpenDoor("unit");
  scene.assets = {skills::WithInertia(tasks::DrawerUnit("unit"))};
  const std::string joint = scene.assets.front().model.joints.front().name;
  scene.subtask.program =
      "def compute_reward(env):\n    moved = env.get_state_by_joint_name(\"unit\", \"" + joint +
      "\")\n    return moved, moved >= 0.2\n";
  return scene;
}

std::shared_ptr<const skills::Skill> TargetGeometryMake(const skills::SkillSubtask& scene) {
  return skills::MakeSkill(robot::Panda(false), {scene}, skills::SkillOptions().ForEvaluation());
}

// Compares the motion of the frame's origin with finite differences when the joint moves by `step`.
void ExpectWayOfDifferences(const skills::SkillVariant& variant, double position) {
  tasks::WorldState state = variant.start;
  double& joint = state.joints[0][static_cast<size_t>(variant.target->joint)];
  joint = position;
  const Eigen::Isometry3d frame = GraspPoseAtJoint(variant.model, state, *variant.target);
  const TargetGeometry geometry = GeometryOf(variant.model, state, *variant.target, frame);
  const double step = 1e-6;
  joint = position + step;
  const Eigen::Isometry3d after = GraspPoseAtJoint(variant.model, state, *variant.target);
  const Vector3d moved = frame.linear().transpose() * (after.translation() - frame.translation());
  EXPECT_LT((geometry.motion_direction - moved.normalized()).norm(), 1e-5);
  if (geometry.hinge.isZero()) {
    EXPECT_NEAR(moved.norm() / step, 1.0, 1e-5);  // prismatic: a metre per metre
  } else {
    EXPECT_NEAR(moved.norm() / step, geometry.hinge.norm(), 1e-5);  // revolute: radius per radian
    EXPECT_NEAR(geometry.hinge.dot(moved.normalized()), 0.0, 1e-5);
    // The point on the axis does not move.
    const Vector3d axis_point = frame * geometry.hinge;
    EXPECT_LT((after * (frame.inverse() * axis_point) - axis_point).norm(), 2e-6);
  }
}

TEST(TargetGeometry, OfADoorAgreesWithItsMotion) {
  const auto skill = TargetGeometryMake(skills::OpenDoor());
  for (const double position : {0.0, 0.4, 1.3}) {
    ExpectWayOfDifferences(skill->variants.front(), position);
  }
}

TEST(TargetGeometry, OfADrawerAgreesWithItsMotion) {
  const auto skill = TargetGeometryMake(OpenDrawer());
  ASSERT_GE(skill->variants.front().target->joint, 0);
  for (const double position : {0.0, 0.15}) {
    ExpectWayOfDifferences(skill->variants.front(), position);
  }
}

TEST(TargetGeometry, SizeIsTheHandlesAsTheHandSeesIt) {
  const auto skill = TargetGeometryMake(skills::OpenDoor());
  const skills::SkillVariant& variant = skill->variants.front();
  const Eigen::Isometry3d frame = GraspPoseAtJoint(variant.model, variant.start, *variant.target);
  const TargetGeometry geometry = GeometryOf(variant.model, variant.start, *variant.target, frame);
  // A bar of 2 x 2 x 20 cm, upright, 6 cm in front of the hinge and 45 cm beside it: the door
  // carries it at a right angle to the line to the hinge, where the frame's z points.
  const double turn = std::atan2(0.06, 0.45), side = 0.02 * (std::cos(turn) + std::sin(turn));
  EXPECT_LT((geometry.size - Vector3d(0.2, side, side)).norm(), 1e-9);
  EXPECT_NEAR(geometry.hinge.norm(), std::hypot(0.06, 0.45), 1e-9);
  EXPECT_LT((geometry.motion_direction + Vector3d::UnitZ()).norm(), 1e-9);
  EXPECT_NEAR(geometry.middle.x(), 0.0, 1e-9);
  EXPECT_NEAR(geometry.middle.y(), 0.0, 1e-9);
}

TEST(TargetGeometry, OfAFreeThingIsItsOutlineTurned) {
  skills::SkillSubtask scene = skills::PickUpCup();
  scene.assets = {skills::WithInertia(tasks::Box("cup", {0.2, 0.04, 0.06}, 0.3))};
  const auto skill = TargetGeometryMake(scene);
  const skills::SkillVariant& variant = skill->variants.front();
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.translation() = variant.start.roots[0].translation() + Vector3d(0.0, 0.0, 0.05);
  frame.rotate(Eigen::AngleAxisd(M_PI / 6, Vector3d::UnitZ()));
  const TargetGeometry geometry = GeometryOf(variant.model, variant.start, *variant.target, frame);
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  EXPECT_LT((geometry.size - Vector3d(0.2 * c + 0.04 * s, 0.2 * s + 0.04 * c, 0.06)).norm(), 1e-9);
  EXPECT_LT((geometry.middle - Vector3d(0.0, 0.0, -0.02)).norm(), 1e-9);
  EXPECT_TRUE(geometry.motion_direction.isZero());
  EXPECT_TRUE(geometry.hinge.isZero());
}

}  // namespace
}  // namespace simwright::manipulation
