// Plans of approach and manipulation, against scenes whose free paths are known.
#include "manipulation/reach_plan.h"

#include <gtest/gtest.h>

#include "manipulation/gripper_penetration.h"
#include "manipulation/tool_path.h"
#include "skills/episode_start.h"
#include "skills/skill_options.h"
#include "tests/geometry/solid_shapes.h"
#include "tests/skills/skill_scene.h"

namespace simwright::manipulation {
namespace {

using Eigen::Vector3d;

// Returns a subtask that shuts a drawer, 0.25 m open, with a cup in it 7 cm behind its front.
skills::SkillSubtask ShutDrawerWithCup() {
  skills::SkillSubtask scene = skills::OpenDoor("unit");
  scene.assets = {skills::WithInertia(tasks::DrawerUnit("unit")),
                  skills::WithInertia(tasks::Cup("cup"))};
  scene.subtask.name = "close_unit_drawer";
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    moved = env.get_state_by_joint_name(\"unit\", \"drawer_joint\")\n"
      "    return -moved, moved <= 0.02\n";
  scene.subtask.start.joints = {{"unit", "drawer_joint", 0.25}};
  const Vector3d unit(0.95, 0.0, 0.2);
  scene.subtask.start.placements[0].world_from_asset.translation() = unit;
  tasks::AssetPlacement cup;
  cup.asset = "cup";
  cup.world_from_asset.translation() =
      unit + Vector3d(-0.02 - 0.25 - 0.165 + 0.07, 0.0, 0.15 - 0.11);
  scene.subtask.start.placements.push_back(cup);
  return scene;
}

// The cup goes with the drawer: held where it was, it would stand in the palm's way.
TEST(PlanReach, MovesWhatLiesInADrawerWithIt) {
  const auto skill = skills::MakeSkill(robot::Panda(false), {ShutDrawerWithCup()},
                                       skills::SkillOptions().ForEvaluation());
  const skills::SkillVariant& variant = skill->variants.front();
  core::Rng rng = core::StreamRng(5, 0);
  const auto plan = PlanReach(*skill, variant, variant.start, skill->robot->home(), rng);
  ASSERT_TRUE(plan);
  EXPECT_TRUE(plan->IsReachable());
}

constexpr double kRadius = 0.044;  // m, of a cup that is too wide for the gripper

// Returns a subtask that picks up a round cup of 64 slats.
skills::SkillSubtask PickUpRoundCup() {
  skills::SkillSubtask scene = skills::PickUpCup("cup", kRadius);
  assets::UrdfLink& body = scene.assets.front().model.links.front();
  const double wall = 0.004;
  body.collisions.clear();
  assets::UrdfShape floor;
  floor.mesh = shapes::Cylinder(kRadius, wall, 64);
  body.collisions.push_back(floor);
  for (int i = 0; i < 64; ++i) {
    std::vector<Vector3d> corners;
    for (const int side : {i, i + 1}) {
      const double angle = 2.0 * M_PI * side / 64;
      for (const double radius : {kRadius - wall, kRadius}) {
        for (const double height : {0.0, 0.09}) {
          corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
        }
      }
    }
    assets::UrdfShape slat;
    slat.mesh = geometry::ConvexHull(corners);
    body.collisions.push_back(slat);
  }
  return scene;
}

TEST(GraspPose, TakesARoundCupAlongAnyDirection) {
  const auto skill = skills::MakeSkill(robot::Panda(false), {PickUpRoundCup()},
                                       skills::SkillOptions().ForEvaluation());
  const skills::SkillVariant& variant = skill->variants.front();
  for (double yaw = -1.5; yaw < 1.5; yaw += 0.11) {
    const Vector3d across(std::cos(yaw), std::sin(yaw), 0.0);
    const Vector3d thin = GraspPose(variant, variant.start, across, 0.0).linear().col(1);
    EXPECT_GT(thin.dot(across), std::cos(M_PI / 72 + 1e-6)) << yaw;  // directions 5 degrees apart
  }
}

// A palm that leans comes down towards the rim in front of the fingers.
TEST(GraspPose, KeepsALeaningPalmOffTheRim) {
  const auto skill = skills::MakeSkill(robot::Panda(false), {PickUpRoundCup()},
                                       skills::SkillOptions().ForEvaluation());
  const skills::SkillVariant& variant = skill->variants.front();
  ASSERT_GT(variant.target->rim, 0.0);
  const SurfacePoints hand = GripperSurface(*skill->robot, 0.005);
  const auto poses =
      WorldLinkPoses(variant.model.objects[0], variant.start.roots[0], variant.start.joints[0]);
  for (const double pitch : {-0.8, -0.6, 0.0, 0.6, 0.8}) {
    const Eigen::Isometry3d tool = GraspPose(variant, variant.start, Vector3d::UnitY(), pitch);
    EXPECT_LT(PenetrationIntoBody(hand, tool, variant.solids[0], poses), 0.001) << pitch;
    EXPECT_LT(tool.translation().z(), 0.09) << "the pads are above the rim";
  }
}

// An object that was taken by a leaning gripper is upright with it.
TEST(PlannedFrom, KeepsTheLeanOfAGripperThatHolds) {
  const auto skill = skills::MakeSkill(robot::Panda(false), {skills::PickUpCup()},
                                       skills::SkillOptions().ForEvaluation());
  const skills::SkillVariant& variant = skill->variants.front();
  core::Rng rng = core::StreamRng(2, 0);
  skills::StartState start = skills::SampleStart(*skill, rng);
  const Eigen::Isometry3d upright =
      robot::ForwardKinematics(skill->robot->arm, Eigen::VectorXd(start.grasp_configuration));
  CartesianFollower follower(*skill, variant, start.grasp_configuration);
  for (const double lean : {0.1, 0.2, 0.4, 0.5}) {
    Eigen::Isometry3d tool = upright;
    tool.translation() += Vector3d(0.0, 0.0, 0.2 * lean);
    tool.linear() = GraspPose(variant, start.state, upright.linear().col(1), lean).linear();
    ASSERT_TRUE(follower.MoveTo(tool)) << lean;
    skills::StartState held = start;
    held.arm = follower.configuration();
    held.held = 0;
    const double pitch = skills::PlannedFrom(*skill, held, rng, skills::Resampling::kNothing).pitch;
    EXPECT_NEAR(pitch, lean > 0.3 ? lean : 0.0, 0.02) << lean;
  }
}

}  // namespace
}  // namespace simwright::manipulation
