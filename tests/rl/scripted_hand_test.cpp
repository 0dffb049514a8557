// What a script makes of skills of several kinds, without any learning.
#include "rl/scripted_hand.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "rl/skill_environment.h"
#include "rl/skill_evaluation.h"
#include "tests/rl/skill_scene.h"

namespace simwright::rl {
namespace {

std::shared_ptr<const Skill> Evaluated(const SkillSubtask& scene) {
  return MakeSkill(robot::Panda(false), {scene}, SkillOptions().ForEvaluation());
}

// A cup in the hand shall stand 25 cm aside.
SkillSubtask PutDownCup() {
  SkillSubtask scene = PickUpCup();
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    thing = env.get_position(\"cup\")\n"
      "    distance = torch.norm(env.get_goal_pose() - thing, dim=-1)\n"
      "    released = torch.logical_not(env.check_grasped(\"cup\"))\n"
      "    return -distance, torch.logical_and(distance <= 0.03, released)\n";
  scene.subtask.goal = Eigen::Vector3d(0.5, 0.25, 0.05);
  scene.subtask.start.held = "cup";
  return scene;
}

TEST(ScriptedHand, PicksACupUp) {
  const auto skill = Evaluated(PickUpCup());
  EXPECT_GE(EvaluateScript(*skill, DrawStarts(*skill, 20, 5)).successes, 17);
}

TEST(ScriptedHand, PutsACupDownAndLetsGo) {
  const auto skill = Evaluated(PutDownCup());
  EXPECT_GE(EvaluateScript(*skill, DrawStarts(*skill, 20, 5)).successes, 14);
}

TEST(ScriptedHand, OpensADoor) {
  const auto skill = Evaluated(OpenDoor());
  EXPECT_GE(EvaluateScript(*skill, DrawStarts(*skill, 20, 5)).successes, 10);
}

TEST(ScriptedHand, IsWhatAnEnvironmentShows) {
  const auto skill = Evaluated(OpenDoor());
  SkillEnvironment environment(skill, 3);
  Rows observations, shown;
  environment.Reset(4, &observations);
  ASSERT_TRUE(environment.Demonstrate(&shown));
  ASSERT_EQ(shown.rows(), 3);
  ASSERT_EQ(shown.cols(), 7);
  // Far from the handle a hand is open and asks for nothing else.
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(shown.row(i).head(6).cwiseAbs().maxCoeff(), 0.0f);
    EXPECT_EQ(shown(i, 6), 1.0f);
  }
}

TEST(ScriptedHand, KnowsNothingOfOtherActionSpaces) {
  SkillOptions options = SkillOptions().ForEvaluation();
  options.action = ActionSpace::kDelta;
  const auto skill = MakeSkill(robot::Panda(false), {OpenDoor()}, options);
  EXPECT_FALSE(HasScript(*skill));
  SkillEnvironment environment(skill, 1);
  Rows observations, shown;
  environment.Reset(4, &observations);
  EXPECT_FALSE(environment.Demonstrate(&shown));
  EXPECT_THROW(EvaluateScript(*skill, DrawStarts(*skill, 1, 1)), core::Error);
}

}  // namespace
}  // namespace simwright::rl
