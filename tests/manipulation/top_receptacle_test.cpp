// Top-opening receptacles, and collision-free paths of an arm, against the drawer unit's own
// numbers (tests/tasks/household.h): its drawer is 0.34 deep, its walls reach 9 cm above the
// drawer's middle, which is 15 cm above the floor, and it slides to -x.
#include "manipulation/top_receptacle.h"

#include <gtest/gtest.h>

#include "manipulation/carry_plan.h"
#include "manipulation/collision_checker.h"
#include "manipulation/goal_displacement.h"
#include "manipulation/ik_solutions.h"
#include "skills/observation.h"
#include "skills/skill_evaluation.h"
#include "tests/skills/skill_scene.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kRim = 0.15 + 0.09, kTopHalfDepth = 0.16, kTopCell = 0.34 / 20;

struct Drawer {
  tasks::WorldModel model = tasks::MakeWorldModel({skills::WithInertia(tasks::DrawerUnit())});
  int link = model.objects[0].FindLink("drawer");

  tasks::WorldState OpenBy(double out) const {
    tasks::InitialState start;
    start.placements = {{"drawer_unit", Isometry3d(Eigen::Translation3d(0.8, 0.0, 0.0)), true}};
    start.joints = {{"drawer_unit", "drawer_joint", out}};
    return tasks::StateOf(model, start);
  }
  const tasks::Receptacle& room() const {
    for (const tasks::Receptacle& receptacle : model.objects[0].receptacles) {
      if (receptacle.link == link) return receptacle;
    }
    throw std::logic_error("the drawer has no room");
  }
  Vector3d InWorld(const tasks::WorldState& state, const Vector3d& point) const {
    const auto poses = tasks::LinkPosesOf(model.objects[0], state.joints[0]);
    return state.roots[0] * poses[static_cast<size_t>(link)] * point;
  }
};

TEST(OpenRoom, OfADrawerIsWhatStandsOut) {
  const Drawer drawer;
  const tasks::WorldState open = drawer.OpenBy(0.2), shut = drawer.OpenBy(0.0);
  ASSERT_TRUE(OpensUpwards(drawer.model, open, 0, drawer.room()));
  // Its middle is 0.34 / 2 behind its front; the middle of the part that is out by 0.2 is 0.1
  // behind it.
  const double front = 0.8 - 0.02 - 0.2 - kTopHalfDepth;
  const Vector3d spot =
      drawer.InWorld(open, PlacementFromAbove(drawer.model, open, 0, drawer.room()));
  EXPECT_NEAR(spot.x(), front + 0.1, kTopCell);
  EXPECT_NEAR(spot.y(), 0.0, kTopCell);
  // No part of a shut drawer is out.
  const Vector3d none =
      drawer.InWorld(shut, PlacementFromAbove(drawer.model, shut, 0, drawer.room()));
  EXPECT_NEAR(none.x(), 0.8 - 0.02 - kTopHalfDepth, kTopCell);
}

TEST(OpenRoom, HasARimThatTheHandGoesOver) {
  const Drawer drawer;
  const tasks::WorldState open = drawer.OpenBy(0.2);
  const Vector3d inside = drawer.InWorld(open, drawer.room().box.center());
  const auto rim = RimHeightAround(drawer.model, open, inside);
  ASSERT_TRUE(rim);
  EXPECT_NEAR(*rim, kRim, 1e-9);
  EXPECT_FALSE(RimHeightAround(drawer.model, open, inside + Vector3d(0.0, 0.0, 0.3)));
}

// Returns a drawer unit in front of the robot, its drawer open, and a block to be put into it.
std::shared_ptr<const skills::Skill> PutIntoDrawer() {
  skills::SkillSubtask scene;
  scene.assets = {skills::WithInertia(tasks::DrawerUnit()),
                  skills::WithInertia(tasks::Box("block", {0.04, 0.04, 0.06}, 0.2))};
  scene.subtask.name = "put_block_into_drawer";
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    thing = env.get_position(\"block\")\n"
      "    low, high = env.get_bounding_box_link(\"drawer_unit\", \"drawer\")\n"
      "    distance = torch.norm(0.5 * (low + high) - thing, dim=-1)\n"
      "    released = torch.logical_not(env.check_grasped(\"block\"))\n"
      "    return -distance, torch.logical_and(distance < 0.12, released)\n";
  tasks::AssetPlacement unit, block;
  unit.asset = "drawer_unit";
  unit.fixed = true;
  unit.world_from_asset.translation() = Vector3d(0.75, 0.0, 0.0);
  block.asset = "block";
  block.world_from_asset.translation() = Vector3d(0.35, -0.3, 0.0);
  scene.subtask.start.placements = {unit, block};
  scene.subtask.start.joints = {{"drawer_unit", "drawer_joint", 0.2}};
  scene.subtask.start.held = "block";
  return skills::MakeSkill(robot::Panda(false), {scene}, skills::SkillOptions().ForEvaluation());
}

TEST(CollisionChecker, KnowsTheFloorAndWhatIsOnTheWay) {
  const auto skill = PutIntoDrawer();
  const skills::SkillVariant& variant = skill->variants.front();
  const CollisionChecker clearance(*skill, variant, variant.start, 1);
  const robot::JointVector home = skill->robot->home();
  EXPECT_TRUE(clearance.IsCollisionFree(home));
  EXPECT_TRUE(clearance.IsPathCollisionFree(home, home));
  core::Rng rng = core::StreamRng(2, 0);
  // A gripper that points down from 6 cm above the floor has its fingertips above it; from 1 cm
  // below the floor they are in it.
  Isometry3d tool = Isometry3d::Identity();
  tool.linear() = Vector3d(1.0, -1.0, -1.0).asDiagonal();
  tool.translation() = Vector3d(0.35, 0.3, 0.06);
  const auto above = SolveIkFromManyStarts(*skill, variant, tool, home, rng);
  ASSERT_FALSE(above.empty());
  EXPECT_TRUE(clearance.IsCollisionFree(above.front().configuration));
  tool.translation().z() = -0.03;
  const auto below = SolveIkFromManyStarts(*skill, variant, tool, home, rng);
  ASSERT_FALSE(below.empty());
  EXPECT_FALSE(clearance.IsCollisionFree(below.front().configuration));
  EXPECT_FALSE(clearance.IsPathCollisionFree(home, below.front().configuration));
  // Straight from one side of the unit to the other, 15 cm above the floor, the arm collides with
  // it.
  tool.translation() = Vector3d(0.6, 0.45, 0.15);
  const auto left = SolveIkFromManyStarts(*skill, variant, tool, home, rng);
  tool.translation() = Vector3d(0.6, -0.45, 0.15);
  ASSERT_FALSE(left.empty());
  const auto right = SolveIkFromManyStarts(*skill, variant, tool, left.front().configuration, rng);
  ASSERT_FALSE(right.empty());
  EXPECT_FALSE(
      clearance.IsPathCollisionFree(left.front().configuration, right.front().configuration));
  // Folded, it passes.
  const auto joint_path =
      PlanSimplePath(*skill, clearance, left.front().configuration, right.front().configuration);
  ASSERT_TRUE(joint_path);
  ASSERT_FALSE(joint_path->empty());
  robot::JointVector at = left.front().configuration;
  for (const robot::JointVector& next : *joint_path) {
    EXPECT_TRUE(clearance.IsPathCollisionFree(at, next));
    at = next;
  }
  EXPECT_TRUE(clearance.IsPathCollisionFree(at, right.front().configuration));
  robot::JointVector turned = home;
  turned[0] += 0.2;
  const auto straight = PlanSimplePath(*skill, clearance, home, turned);
  ASSERT_TRUE(straight);
  EXPECT_TRUE(straight->empty());
  EXPECT_FALSE(PlanSimplePath(*skill, clearance, home, below.front().configuration));
}

TEST(CarryPlan, ArrivesAboveTheDrawerInNothing) {
  const auto skill = PutIntoDrawer();
  const skills::SkillVariant& variant = skill->variants.front();
  int planned = 0, clear = 0;
  for (const skills::StartState& start : skills::SampleStarts(*skill, 12, 3)) {
    CarryTask task;
    task.there = variant.subtask.start.world_from_robot *
                 robot::ForwardKinematics(skill->robot->arm, start.grasp_configuration);
    task.there.translation() += manipulation::DisplacementToDestination(variant, start.state);
    task.back = Vector3d(0.0, 0.0, 0.15);
    task.may_turn = true;
    const auto plan = PlanCarry(*skill, variant, start.state, task, start.arm);
    if (!plan) continue;
    ++planned;
    Isometry3d before = task.there;
    before.linear() = Eigen::AngleAxisd(plan->turn, Vector3d::UnitZ()) * before.linear();
    before.translation() += task.back;
    const Isometry3d tool = variant.subtask.start.world_from_robot *
                            robot::ForwardKinematics(skill->robot->arm, plan->arrival);
    EXPECT_LT((tool.translation() - before.translation()).norm(), 2e-3);
    EXPECT_LT(Eigen::AngleAxisd(tool.linear().transpose() * before.linear()).angle(), 0.02);
    const CollisionChecker checker(*skill, variant, start.state, 1);
    bool path_clear = true;
    robot::JointVector from = start.arm;
    JointPath path = plan->waypoints;
    path.push_back(plan->arrival);
    for (const robot::JointVector& to : path) {
      path_clear = path_clear && checker.IsPathCollisionFree(from, to);
      from = to;
    }
    clear += path_clear;
  }
  EXPECT_GE(planned, 10);
  EXPECT_GE(clear, 8);
}

}  // namespace
}  // namespace simwright::manipulation
