// The scripted expert on skills of several kinds, without any learning.
#include "skills/scripted_expert.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "manipulation/goal_displacement.h"
#include "skills/observation.h"
#include "skills/skill_environment.h"
#include "skills/skill_evaluation.h"
#include "tests/skills/skill_scene.h"

namespace simwright::skills {
namespace {

std::shared_ptr<const Skill> Evaluated(const SkillSubtask& scene) {
  return MakeSkill(robot::Panda(false), {scene}, SkillOptions().ForEvaluation());
}

// Returns a subtask that places a grasped cup 25 cm aside.
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

// Returns a subtask that pushes a slippery box by 12 cm.
SkillSubtask PushBox() {
  SkillSubtask scene = PickUpCup();
  scene.assets = {WithInertia(tasks::Box("cup", {0.1, 0.2, 0.08}, 0.2))};
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    missing = torch.norm((env.get_goal_pose() - env.get_position(\"cup\"))[:, :2], dim=-1)\n"
      "    return -missing, missing <= 0.03\n";
  scene.subtask.goal = Eigen::Vector3d(0.5, 0.12, 0.04);
  return scene;
}

SkillSubtask LiftLid() {
  SkillSubtask scene;
  scene.assets = {WithInertia(tasks::Chest())};
  scene.subtask.name = "open_chest";
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    handle = env.get_pose_by_link_name(\"chest\", \"handle\")\n"
      "    reach = torch.norm(env.get_robot_gripper_pose() - handle, dim=-1)\n"
      "    moved = env.get_state_by_joint_name(\"chest\", \"lid_joint\") / 1.5\n"
      "    return 2.0 * moved - reach, moved >= 0.7\n";
  tasks::AssetPlacement placement;
  placement.asset = "chest";
  placement.fixed = true;
  placement.world_from_asset.translation() = Eigen::Vector3d(0.5, 0.0, 0.0);
  scene.subtask.start.placements = {placement};
  return scene;
}

// Returns a subtask that shuts a drawer with a bar, which is open by 19 cm.
SkillSubtask ShutDrawer() {
  assets::SemanticModel chest;
  chest.name = "chest";
  assets::UrdfLink body = tasks::MakeLink("body", 5.0), drawer = tasks::MakeLink("drawer", 0.5);
  body.collisions = {tasks::Block({0.3, 0.4, 0.1}, {0.15, 0.0, 0.05}),
                     tasks::Block({0.3, 0.4, 0.1}, {0.15, 0.0, 0.35})};
  drawer.collisions = {tasks::Block({0.02, 0.36, 0.18}, {-0.01, 0.0, 0.0}),
                       tasks::Block({0.012, 0.12, 0.012}, {-0.05, 0.0, 0.0}),
                       tasks::Block({0.03, 0.012, 0.012}, {-0.03, 0.05, 0.0}),
                       tasks::Block({0.03, 0.012, 0.012}, {-0.03, -0.05, 0.0})};
  chest.model.links = {body, drawer};
  chest.model.joints = {tasks::MakeJoint("drawer_joint", "body", "drawer",
                                         assets::JointType::kPrismatic, {0.0, 0.0, 0.2}, {-1, 0, 0},
                                         0.0, 0.2)};
  SkillSubtask scene;
  scene.assets = {WithInertia(chest)};
  scene.subtask.name = "close_chest_drawer";
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    open = env.get_state_by_joint_name(\"chest\", \"drawer_joint\")\n"
      "    return -open, open <= 0.01\n";
  tasks::AssetPlacement placement;
  placement.asset = "chest";
  placement.fixed = true;
  placement.world_from_asset.translation() = Eigen::Vector3d(0.75, 0.0, 0.0);
  scene.subtask.start.placements = {placement};
  scene.subtask.start.joints = {{"chest", "drawer_joint", 0.19}};
  return scene;
}

// Fingers that push on would slide off the handle, and pull the drawer open as they go back to it.
TEST(ScriptedHand, StopsPushingADrawerThatIsShut) {
  const auto skill = Evaluated(ShutDrawer());
  Episode episode(*skill);
  episode.Begin(SampleStarts(*skill, 1, 5).front());
  std::vector<float> action(7);
  Decision decision;
  double lead_while_open = 0.0;  // m, the largest of the command
  while (!decision.terminated && !decision.truncated) {
    ExpertAction(episode, action.data());
    const double lead = skill->options.reach * Eigen::Vector3f(action.data()).norm();
    if (action[6] < 0.0f && episode.state().joints[0][0] > 0.05) {
      lead_while_open = std::max(lead_while_open, lead);
    }
    decision = episode.Step(action.data());
  }
  EXPECT_TRUE(decision.terminated);
  EXPECT_NEAR(lead_while_open, 0.06, 1e-6);
  EXPECT_LT(episode.state().joints[0][0], 0.01);
  ExpertAction(episode, action.data());
  EXPECT_LE(skill->options.reach * Eigen::Vector3f(action.data()).norm(),
            std::abs(episode.state().joints[0][0]) + 0.01 + 1e-6);
}

TEST(ScriptedHand, PicksACupUp) {
  const auto skill = Evaluated(PickUpCup());
  EXPECT_GE(EvaluateScriptedExpert(*skill, SampleStarts(*skill, 20, 5)).successes, 17);
}

TEST(ScriptedHand, PutsACupDownAndLetsGo) {
  const auto skill = Evaluated(PutDownCup());
  EXPECT_GE(EvaluateScriptedExpert(*skill, SampleStarts(*skill, 20, 5)).successes, 14);
}

// Wide cups are held by their rim, from which they hang; narrow ones between the fingers.
TEST(ScriptedHand, AcceleratesItsJointsTogetherWithWhatHangsFromItsRim) {
  for (const double radius : {0.03, 0.06}) {
    SkillSubtask scene = PutDownCup();
    scene.assets = PickUpCup("cup", radius).assets;
    const auto skill = Evaluated(scene);
    EXPECT_EQ(skill->variants.front().target->rim > 0.0, radius > 0.04);
    Episode episode(*skill);
    episode.Begin(SampleStarts(*skill, 1, 5).front());
    std::vector<float> action(7);
    int there = 0;
    for (Decision decision; !decision.terminated && !decision.truncated;) {
      ExpertAction(episode, action.data());
      const bool at_destination = episode.frame().at_destination() && !episode.frame().retreating();
      decision = episode.Step(action.data());
      if (!at_destination) continue;
      ++there;
      EXPECT_EQ(episode.command().together, radius > 0.04);
    }
    EXPECT_GT(there, 5);
  }
}

TEST(ScriptedHand, OpensADoor) {
  const auto skill = Evaluated(OpenDoor());
  EXPECT_GE(EvaluateScriptedExpert(*skill, SampleStarts(*skill, 20, 5)).successes, 10);
}

TEST(ScriptedHand, ShutsADoor) {
  const auto skill = Evaluated(CloseDoor());
  EXPECT_GE(EvaluateScriptedExpert(*skill, SampleStarts(*skill, 20, 5)).successes, 18);
}

// A box that is pushed as hard as the arm can slides past its goal, and must not be pushed on.
TEST(ScriptedHand, PushesAThingToItsGoalAndNotPastIt) {
  const auto skill = Evaluated(PushBox());
  EXPECT_GE(EvaluateScriptedExpert(*skill, SampleStarts(*skill, 40, 5)).successes, 34);
}

TEST(ScriptedHand, LeavesWhatHasSlidPastItsGoal) {
  const auto skill = Evaluated(PushBox());
  Episode episode(*skill);
  episode.Begin(SampleStarts(*skill, 1, 5).front());
  std::vector<float> action(7);
  Decision decision;
  bool pushed = false, past = false;
  while (!decision.terminated && !decision.truncated) {
    ExpertAction(episode, action.data());
    const SkillVariant& variant = skill->variants.front();
    const double missing = manipulation::DisplacementToDestination(variant, episode.state())
                               .dot(episode.frame().world_from_target().linear().col(0));
    pushed = pushed || action[0] > 0.0f;
    past = past || missing < 0.0;
    if (missing < 0.0) {
      EXPECT_EQ(action[0], 0.0f);
    }
    // Pushes as hard as the arm can: it slides past.
    if (action[0] > 0.0f && !past) action[0] = 1.0f;
    decision = episode.Step(action.data());
  }
  EXPECT_TRUE(pushed && past);
}

// With wide open fingers, one finger of a leaning gripper would stand on the lid.
TEST(ScriptedHand, LiftsALid) {
  const auto skill = Evaluated(LiftLid());
  EXPECT_GE(EvaluateScriptedExpert(*skill, SampleStarts(*skill, 40, 5)).successes, 36);
}

// A gripper that shuts the door later has to get behind it; otherwise wide open is better.
TEST(ScriptedHand, OpensADoorThatIsShutLaterLittleWiderThanItHasTo) {
  const auto alone = Evaluated(OpenDoor());
  const auto shut = MakeSkill(robot::Panda(false), {OpenDoor()}, SkillOptions().ForEvaluation(),
                              {Evaluated(CloseDoor())});
  const std::vector<StartState> starts = SampleStarts(*shut, 20, 5);
  const SkillEvaluation wide = EvaluateScriptedExpert(*alone, starts);
  const SkillEvaluation little = EvaluateScriptedExpert(*shut, starts);
  EXPECT_GE(little.successes, wide.successes - 1);  // success lasts
  const auto door = static_cast<size_t>(shut->variants.front().target->joint);
  const auto opened = [&](const SkillEvaluation& evaluation, size_t i) {
    return evaluation.episodes[i].end.state.joints[0][door];
  };
  int both = 0;
  double wider = 0.0;
  for (size_t i = 0; i < starts.size(); ++i) {
    if (!wide.episodes[i].success || !little.episodes[i].success) continue;
    ++both;
    wider += opened(wide, i) - opened(little, i);
    EXPECT_GE(opened(little, i), 0.7 * 1.7);
  }
  ASSERT_GE(both, 8);
  EXPECT_GT(wider / both, 0.05);
}

TEST(ScriptedHand, IsWhatAnEnvironmentShows) {
  const auto skill = Evaluated(OpenDoor());
  SkillEnvironment environment(skill, 3);
  rl::Rows observations, shown;
  environment.Reset(4, &observations);
  ASSERT_TRUE(environment.Demonstrate(&shown));
  ASSERT_EQ(shown.rows(), 3);
  ASSERT_EQ(shown.cols(), 7);
  // Far from the handle, and off its axis, the gripper is open and stays back.
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(shown.row(i).head(2).cwiseAbs().maxCoeff(), 0.0f);
    EXPECT_NEAR(shown(i, 2), -0.04 / SkillOptions().reach, 1e-6);
    EXPECT_EQ(shown.row(i).segment(3, 3).cwiseAbs().maxCoeff(), 0.0f);
    EXPECT_EQ(shown(i, 6), 1.0f);
  }
}

TEST(ScriptedHand, IsWhatAGuidedHandDoesByItself) {
  SkillOptions options = SkillOptions().ForEvaluation();
  const auto target = MakeSkill(robot::Panda(false), {OpenDoor()}, options);
  options.action = ActionSpace::kGuided;
  const auto guided = MakeSkill(robot::Panda(false), {OpenDoor()}, options);
  const StartState start = SampleStarts(*target, 1, 7).front();
  Episode by_script(*target), by_itself(*guided), overruled(*guided);
  by_script.Begin(start);
  by_itself.Begin(start);
  overruled.Begin(start);
  float action[7], none[7] = {}, closing[7] = {0, 0, 0, 0, 0, 0, -1};
  for (int i = 0; i < 60; ++i) {
    ExpertAction(by_script, action);
    by_script.Step(action);
    by_itself.Step(none);
    if (i < 16) overruled.Step(closing);
  }
  EXPECT_EQ(by_script.state().joints, by_itself.state().joints);
  EXPECT_TRUE(by_script.state().gripper.matrix() == by_itself.state().gripper.matrix());
  EXPECT_LT(overruled.state().opening, 0.03);  // the scripted expert leaves it open there
}

TEST(ScriptedHand, KnowsNothingOfOtherActionSpaces) {
  SkillOptions options = SkillOptions().ForEvaluation();
  options.action = ActionSpace::kDelta;
  const auto skill = MakeSkill(robot::Panda(false), {OpenDoor()}, options);
  EXPECT_FALSE(HasScriptedExpert(*skill));
  SkillEnvironment environment(skill, 1);
  rl::Rows observations, shown;
  environment.Reset(4, &observations);
  EXPECT_FALSE(environment.Demonstrate(&shown));
  EXPECT_THROW(EvaluateScriptedExpert(*skill, SampleStarts(*skill, 1, 1)), core::Error);
}

}  // namespace
}  // namespace simwright::skills
