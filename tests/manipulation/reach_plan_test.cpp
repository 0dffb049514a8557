// Plans of approach and manipulation, against scenes whose free paths are known.
#include "manipulation/reach_plan.h"

#include <gtest/gtest.h>

#include "skills/skill_options.h"
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

}  // namespace
}  // namespace simwright::manipulation
