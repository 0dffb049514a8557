// A subtask as an environment: its interaction target, and how episodes begin, proceed and end.
#include "skills/skill.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "manipulation/collision_checker.h"
#include "skills/scripted_expert.h"
#include "skills/skill_environment.h"
#include "skills/skill_evaluation.h"
#include "skills/start_pool.h"
#include "tests/skills/skill_scene.h"

namespace simwright::skills {
namespace {

using Eigen::Vector3d;

std::shared_ptr<const Skill> Make(const std::vector<SkillSubtask>& subtasks,
                                  const SkillOptions& options = SkillOptions().ForEvaluation()) {
  return MakeSkill(robot::Panda(false), subtasks, options);
}

TEST(InteractionTarget, OfADoorIsItsHandleFromTheFront) {
  const auto skill = Make({OpenDoor()});
  const SkillVariant& variant = skill->variants.front();
  ASSERT_TRUE(variant.target);
  EXPECT_EQ(variant.model.objects[0].LinkName(variant.target->link), "handle");
  EXPECT_FALSE(variant.destination);
  const Eigen::Isometry3d tool =
      manipulation::GraspPose(variant, variant.start, Vector3d::UnitX(), 0.0);
  // The front faces -x, the handle is upright at (0.75 - 0.26, 0.15 + 0.25 - 0.45, 0.15).
  EXPECT_LT((tool.translation() - Vector3d(0.49, -0.05, 0.15)).norm(), 1e-9);
  EXPECT_LT((tool.linear().col(2) - Vector3d::UnitX()).norm(), 0.15);  // along the door's motion
  EXPECT_LT(std::abs(tool.linear().col(1).z()), 0.05);                 // across the bar
  // With the door open by a quarter turn the gripper approaches along its new normal.
  tasks::WorldState open = variant.start;
  open.joints[0][static_cast<size_t>(variant.target->joint)] = M_PI / 2;
  const Eigen::Isometry3d turned =
      manipulation::GraspPose(variant, open, tool.linear().col(1), 0.0);
  const Eigen::Matrix3d turn = turned.linear() * tool.linear().transpose();
  EXPECT_NEAR(std::abs(Eigen::AngleAxisd(turn).angle()), M_PI / 2, 1e-9);
}

TEST(InteractionTarget, OfAThingIsTakenFromAboveAcrossItsThinSide) {
  SkillSubtask scene = PickUpCup();
  scene.assets = {WithInertia(tasks::Box("cup", {0.2, 0.04, 0.06}, 0.3))};
  const auto skill = Make({scene});
  const SkillVariant& variant = skill->variants.front();
  ASSERT_TRUE(variant.destination);
  EXPECT_TRUE(variant.destination->goal);
  tasks::WorldState state = variant.start;
  state.roots[0].rotate(Eigen::AngleAxisd(0.6, Vector3d::UnitZ()));
  const Eigen::Isometry3d tool = manipulation::GraspPose(variant, state, Vector3d::UnitX(), 0.0);
  EXPECT_LT((tool.linear().col(2) + Vector3d::UnitZ()).norm(), 1e-9);
  const Vector3d thin = state.roots[0].linear().col(1);
  EXPECT_GT(std::abs(tool.linear().col(1).dot(thin)), std::cos(0.05));
  // 2 cm below the top: the palm is that far from the fingertips.
  EXPECT_NEAR(tool.translation().z(), 0.04, 1e-9);
}

TEST(InteractionTarget, OfARoundThingStaysNearTheHand) {
  const auto skill = Make({PickUpCup()});
  const SkillVariant& variant = skill->variants.front();
  for (const double yaw : {-1.2, -0.3, 0.0, 0.8, 1.5}) {
    // The cup is an octagon: one of its four pairs of sides is within a sixteenth of a turn.
    const Vector3d across(std::cos(yaw), std::sin(yaw), 0.0);
    const Eigen::Isometry3d tool = manipulation::GraspPose(variant, variant.start, across, 0.0);
    EXPECT_GT(tool.linear().col(1).dot(across), std::cos(M_PI / 8 + 0.01));
  }
}

TEST(SampleStart, KeepsItsRangesAndCanBeWorkedAt) {
  const auto skill = Make({OpenDoor()});
  const SkillVariant& variant = skill->variants.front();
  for (const StartState& start : SampleStarts(*skill, 60, 4)) {
    const Eigen::Isometry3d moved = variant.start.roots[0].inverse() * start.state.roots[0];
    EXPECT_LE(Eigen::AngleAxisd(moved.linear()).angle(), skill->options.furniture_yaw + 1e-9);
    const Vector3d shift = tasks::LinkPosition(variant.model, start.state, 0, 0) -
                           tasks::LinkPosition(variant.model, variant.start, 0, 0);
    EXPECT_LE(shift.cwiseAbs().maxCoeff(), skill->options.position_range + 1e-9);
    const Eigen::Isometry3d reached =
        robot::ForwardKinematics(skill->robot->arm, Eigen::VectorXd(start.grasp_configuration));
    const Eigen::Isometry3d wanted =
        manipulation::GraspPose(variant, start.state, reached.linear().col(1), start.pitch);
    EXPECT_LT((wanted.translation() - reached.translation()).norm(), 2e-3);
    EXPECT_GE(start.mass[0], skill->options.mass.low);
    EXPECT_LE(start.mass[0], skill->options.mass.high);
  }
}

// An open drawer extends to where the arm begins: objects are moved away until the arm is
// collision-free and still reaches its target.
TEST(SampleStart, LeavesTheArmRoom) {
  SkillSubtask scene = OpenDoor("unit");
  scene.assets = {WithInertia(tasks::DrawerUnit("unit"))};
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    moved = env.get_state_by_joint_name(\"unit\", \"drawer_joint\")\n"
      "    return -moved, moved <= 0.02\n";
  scene.subtask.start.joints = {{"unit", "drawer_joint", 0.25}};
  scene.subtask.start.placements[0].world_from_asset.translation() =
      Eigen::Vector3d(0.62, 0.165, 0.33);
  const auto skill = Make({scene});
  const SkillVariant& variant = skill->variants.front();
  EXPECT_FALSE(
      manipulation::IsArmCollisionFree(*skill, variant, variant.start, skill->robot->home()));
  for (const StartState& start : SampleStarts(*skill, 40, 4)) {
    EXPECT_TRUE(manipulation::IsArmCollisionFree(*skill, variant, start.state, start.arm));
    EXPECT_GT((start.grasp_configuration - skill->robot->home()).norm(), 1e-6);  // a plan was made
    // No contact pushes arm or drawer before the first action.
    Episode episode(*skill);
    episode.Begin(start);
    EXPECT_LT(std::abs(episode.state().joints[0][0] - 0.25), 1e-3);
  }
}

TEST(Episode, AScriptedHandPicksUpTheCup) {
  const auto skill = Make({PickUpCup()});
  Episode episode(*skill);
  int successes = 0;
  const auto starts = SampleStarts(*skill, 12, 11);
  for (const StartState& start : starts) {
    episode.Begin(start);
    Decision decision;
    float action[7];
    int held = 0;
    while (!decision.terminated && !decision.truncated) {
      ExpertAction(episode, action);
      decision = episode.Step(action);
      held = decision.success ? held + 1 : 0;
    }
    EXPECT_FALSE(decision.failed);
    successes += decision.terminated;
    if (!decision.terminated) continue;
    EXPECT_EQ(held, 10);  // 0.5 s at 20 Hz
    EXPECT_NEAR(tasks::LinkPosition(skill->variants[0].model, episode.state(), 0, 0).z(), 0.2,
                0.03);
    EXPECT_TRUE(episode.state().grasped);
  }
  EXPECT_GE(successes, 11);
}

// An end by success is worth as much as success forever: r / (1 - discount).
TEST(Episode, SuccessIsPaidAsIfItWentOn) {
  SkillOptions options = SkillOptions().ForEvaluation();
  options.hold_seconds = 0.0;
  SkillSubtask scene = PickUpCup();
  scene.subtask.program =
      "def compute_reward(env):\n"
      "    thing = env.get_position(\"cup\")\n"
      "    return thing[:, 2] * 0.0 + 0.25, thing[:, 2] < 10.0\n";
  const auto skill = Make({scene}, options);
  Episode episode(*skill);
  episode.Begin(SampleStarts(*skill, 1, 1).front());
  const float still[7] = {};
  const Decision decision = episode.Step(still);
  EXPECT_TRUE(decision.terminated);
  EXPECT_NEAR(decision.reward, (0.25 + options.success_bonus) / (1.0 - options.discount), 1e-4);
}

TEST(Episode, TimeEndsItAsTruncated) {
  SkillOptions options = SkillOptions().ForEvaluation();
  options.episode_seconds = 0.5;
  const auto skill = Make({PickUpCup()}, options);
  Episode episode(*skill);
  episode.Begin(SampleStarts(*skill, 1, 1).front());
  const float still[7] = {};
  for (int i = 1; i <= 10; ++i) {
    const Decision decision = episode.Step(still);
    EXPECT_FALSE(decision.terminated);
    EXPECT_EQ(decision.truncated, i == 10);
  }
}

void RandomActions(core::Rng& rng, rl::Rows* actions) {
  for (Eigen::Index i = 0; i < actions->size(); ++i) {
    actions->data()[i] = static_cast<float>(core::Uniform(rng, -1.0, 1.0));
  }
}

// The same bytes on one thread and on two, and from a saved state.
TEST(SkillEnvironment, RepeatsItselfBitForBit) {
  SkillOptions options;
  options.episode_seconds = 0.8;  // so that episodes end meanwhile
  const auto skill = Make({PickUpCup(), PickUpCup("beaker", 0.025)}, options);
  const int threads = core::ThreadCount();
  std::vector<rl::Rows> seen;
  std::string saved;
  for (int run = 0; run < 3; ++run) {
    core::SetThreadCount(run == 1 ? 1 : 2);
    SkillEnvironment environment(skill, 4);
    rl::Rows observations, actions(4, environment.action_size());
    rl::StepBatch batch;
    core::Rng rng(3);
    environment.Reset(9, &observations);
    for (int step = 0; step < 24; ++step) {
      RandomActions(rng, &actions);
      if (run == 2 && step == 10) environment.RestoreState(saved, &observations);
      environment.Step(actions, &batch);
      if (run == 0) seen.push_back(batch.observations);
      if (run == 0 && step == 9) saved = environment.SaveState();
      if (run == 2 && step < 10) continue;
      ASSERT_EQ(seen[static_cast<size_t>(step)], batch.observations) << run << " " << step;
    }
    EXPECT_TRUE(batch.observations.allFinite());
    EXPECT_EQ(environment.failures(), 0);
    EXPECT_EQ(environment.LastFailure(), "");
  }
  core::SetThreadCount(threads);
  SkillEnvironment other(skill, 3);
  rl::Rows observations;
  EXPECT_THROW(other.RestoreState(saved, &observations), core::Error);
  SkillEnvironment same(skill, 4);
  EXPECT_THROW(same.RestoreState(saved.substr(0, saved.size() / 2), &observations), core::Error);
}

// A gripper on a door's handle grasps no object that the next skill could start with.
TEST(HeldObject, IsNoFurniture) {
  for (const auto& [scene, held] : {std::pair{OpenDoor(), -1}, {PickUpCup(), 0}}) {
    const auto skill = Make({scene});
    const SkillVariant& variant = skill->variants.front();
    tasks::WorldState state = variant.start;
    state.touched = 0;
    EXPECT_EQ(HeldObject(variant, state), -1);
    state.grasped = true;
    EXPECT_EQ(HeldObject(variant, state), held);
    StartState start = SampleStarts(*skill, 1, 2).front();
    start.held = 0;
    if (held < 0) {
      EXPECT_THROW(ParseStart(StartText(start), *skill, "test"), core::Error);
    }
  }
}

// A grasped cup that is only to be held, or held while a door is opened, has no destination.
TEST(Episode, WhatIsHeldMayHaveNoDestination) {
  SkillSubtask hold = PickUpCup();
  hold.subtask.program =
      "def compute_reward(env):\n"
      "    grasped = env.check_grasped(\"cup\")\n"
      "    return grasped.float(), grasped\n";
  hold.subtask.start.held = "cup";
  SkillSubtask open = OpenDoor();
  open.assets.push_back(WithInertia(tasks::Cup("cup", 0.03)));
  tasks::AssetPlacement placement;
  placement.asset = "cup";
  placement.world_from_asset.translation() = Vector3d(0.4, -0.3, 0.0);
  open.subtask.start.placements.push_back(placement);
  open.subtask.start.held = "cup";
  for (const SkillSubtask& scene : {hold, open}) {
    const auto skill = Make({scene});
    const SkillVariant& variant = skill->variants.front();
    ASSERT_TRUE(variant.starts_held && !variant.destination);
    const manipulation::TargetFrame frame(variant, variant.start, Vector3d::UnitY(), 0.0);
    EXPECT_FALSE(frame.at_destination());
    EXPECT_EQ(frame.retreat_distance(), 0.0);
    Episode episode(*skill);
    episode.Begin(SampleStarts(*skill, 1, 3).front());
    float action[7];
    for (int i = 0; i < 5; ++i) {
      ExpertAction(episode, action);
      EXPECT_FALSE(episode.Step(action).failed);
    }
  }
}

TEST(StartPool, ReadsWhatItWrites) {
  const auto skill = Make({OpenDoor()});
  StartState start = SampleStarts(*skill, 3, 8).back();
  start.waypoints = {skill->robot->home(), start.grasp_configuration};
  const StartState read = ParseStart(StartText(start), *skill, "test");
  EXPECT_EQ(StartText(read), StartText(start));
  // The start states are identical to the last bit: both episodes proceed identically.
  Episode a(*skill), b(*skill);
  a.Begin(start);
  b.Begin(read);
  const float action[7] = {0.1f, -0.2f, 0.0f, 0.0f, 0.3f, 0.0f, 1.0f};
  for (int step = 0; step < 5; ++step) EXPECT_EQ(a.Step(action).reward, b.Step(action).reward);
  EXPECT_EQ(read.waypoints.size(), 2u);
  StartState far = start;
  far.waypoints.assign(17, start.arm);
  EXPECT_THROW(ParseStart(StartText(far), *skill, "test"), core::Error);
  const std::string text = StartText(start);
  for (const std::string& bad :
       {std::string(), std::string("{}"), text.substr(0, text.size() / 2), std::string("[1]")}) {
    EXPECT_THROW(ParseStart(bad, *skill, "test"), core::Error);
  }
}

std::string ErrorOf(const std::vector<SkillSubtask>& subtasks) {
  try {
    Make(subtasks);
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

TEST(MakeSkill, RefusesWhatCannotBeLearnt) {
  SkillSubtask silent = PickUpCup();
  silent.subtask.program = "def compute_reward(env):\n    return env.get_position(\"cup\")[:, 2]\n";
  EXPECT_NE(ErrorOf({silent}).find("returns no success"), std::string::npos);
  SkillSubtask wrong = PickUpCup();
  wrong.subtask.program = "def compute_reward(env):\n    return env.get_position(\"cub\")[:, 2]\n";
  EXPECT_NE(ErrorOf({wrong}).find("pick_up_cup"), std::string::npos);
  EXPECT_NE(ErrorOf({PickUpCup(), OpenDoor()}).find("other inputs"), std::string::npos);
  SkillOptions options;
  options.substeps = 0;
  EXPECT_THROW(Make({PickUpCup()}, options), core::Error);
}

}  // namespace
}  // namespace simwright::skills
