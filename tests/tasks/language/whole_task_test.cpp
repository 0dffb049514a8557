// A task as one program: its outputs are those of its subtasks' programs, combined.
#include "tasks/language/whole_task.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "reward/reward_program.h"
#include "tasks/rules/rule_tasks.h"
#include "tasks/world_signals.h"
#include "tests/tasks/household.h"

namespace simwright::tasks {
namespace {

struct Gain {
  float reward = 0.0f;
  bool success = false;
};

Gain GainOf(const WorldModel& model, const Subtask& subtask, WorldState state) {
  const reward::CompileOutcome outcome = reward::CompileReward(subtask.program, &model.names);
  for (const core::Finding& finding : outcome.findings) {
    EXPECT_NE(finding.severity, core::Severity::kError)
        << finding.sentence << " " << finding.place << "\n"
        << subtask.program;
  }
  if (!outcome.program) return {};
  if (subtask.goal) state.goal = *subtask.goal;
  SignalReader reader(model, outcome.program->slots());
  std::vector<std::vector<float>> values;
  reader.Read(state, &state, 0.05, &values);
  std::vector<reward::RewardBinding> bindings(values.size());
  for (size_t i = 0; i < values.size(); ++i) bindings[i].data = values[i].data();
  reward::RewardWorkspace workspace(*outcome.program, 1);
  Gain gain;
  std::uint8_t done = 0;
  outcome.program->Run(bindings, 1, &workspace, &gain.reward, &done);
  gain.success = done != 0;
  return gain;
}

class WholeTaskTest : public ::testing::Test {
 protected:
  WholeTaskTest() : model_(MakeWorldModel({Microwave(), Cup()})) {
    RuleOptions options;
    options.count = 60;
    for (const Task& task : GenerateTasksByRules(model_, options).tasks) {
      if (task.name == "put_cup_into_microwave_and_close_it") task_ = task;
    }
  }
  // Returns a state that no subtask anticipates.
  WorldState AnyState(core::Rng& rng) const {
    WorldState state = StateOf(model_, task_.subtasks.front().start);
    for (auto& joints : state.joints) {
      for (double& joint : joints) joint = core::Uniform(rng, 0.0, 1.7);
    }
    for (Eigen::Isometry3d& root : state.roots) {
      root.translation() +=
          Eigen::Vector3d(core::Uniform(rng, -0.3, 0.3), core::Uniform(rng, -0.3, 0.3), 0.0);
    }
    state.gripper.translation() =
        Eigen::Vector3d(core::Uniform(rng, 0.2, 0.8), core::Uniform(rng, -0.5, 0.5), 0.2);
    state.touched = core::Uniform(rng) < 0.5 ? model_.Find("cup") : -1;
    state.grasped = state.touched >= 0;
    return state;
  }

  WorldModel model_;
  Task task_;
};

TEST_F(WholeTaskTest, ItsRewardIsTheSumAndItsSuccessAllOfThem) {
  ASSERT_EQ(task_.subtasks.size(), 4u);
  // A second goal, so that one of them must be written into the program.
  ASSERT_TRUE(task_.subtasks[1].goal);
  task_.subtasks[3].goal = Eigen::Vector3d(0.1, 0.2, 0.3);
  task_.subtasks[3].program =
      "def compute_reward(env):\n"
      "    off = torch.norm(env.get_goal_pose() - env.get_position(\"cup\"), dim=-1)\n"
      "    return -off, off <= 0.4\n";
  const SubtaskSelection parts{{true, true, false, true}, {false, false, true, true}};
  const Task whole = MergeSubtasks(task_, parts, "whole");
  ASSERT_EQ(whole.subtasks.size(), 1u);
  EXPECT_EQ(whole.name, "whole");
  EXPECT_EQ(whole.subtasks[0].start.placements.size(), task_.subtasks[0].start.placements.size());
  core::Rng rng(5);
  for (int i = 0; i < 50; ++i) {
    const WorldState state = AnyState(rng);
    std::vector<Gain> gains;
    for (const Subtask& subtask : task_.subtasks) gains.push_back(GainOf(model_, subtask, state));
    const Gain all = GainOf(model_, whole.subtasks[0], state);
    EXPECT_NEAR(all.reward, gains[0].reward + gains[1].reward + gains[3].reward, 1e-5);
    EXPECT_EQ(all.success, gains[2].success && gains[3].success);
  }
}

TEST_F(WholeTaskTest, WhatCannotBePutTogetherIsRefused) {
  EXPECT_THROW(MergeSubtasks(task_, {{true}, {true}}, "w"), core::Error);
  const std::vector<bool> none(4, false), all(4, true);
  EXPECT_THROW(MergeSubtasks(task_, {none, all}, "w"), core::Error);
  EXPECT_THROW(MergeSubtasks(task_, {all, none}, "w"), core::Error);
  task_.subtasks[2].program = "x = 1\n";
  EXPECT_THROW(MergeSubtasks(task_, {all, all}, "w"), core::Error);
}

}  // namespace
}  // namespace simwright::tasks
