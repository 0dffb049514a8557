// Parameters of a program are inferred, given, or reported as assumed.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "reward/reward_program.h"

namespace simwright::reward {
namespace {

TEST(RewardParameters, ShapesAreInferredOrGiven) {
  const std::string source =
      "def compute_reward(tips: torch.Tensor, weight: torch.Tensor, gain: float):\n"
      "    n, k, d = tips.shape\n    near = torch.norm(tips - weight.unsqueeze(1), dim=-1)\n"
      "    return near.sum(dim=1) * gain\n";
  RewardOptions options;
  options.parameter_shapes["tips"] = {5, 3};
  const CompileOutcome given = CompileReward(source, nullptr, options);
  ASSERT_TRUE(given.program.has_value()) << RenderFinding(given.findings[0], source);
  EXPECT_EQ(given.program->slots()[0].shape, "[N, 5, 3]");
  EXPECT_EQ(given.program->slots()[1].shape, "[N, 3]");
  EXPECT_TRUE(given.program->slots()[2].uniform);
  EXPECT_TRUE(CompileReward(source, nullptr).program.has_value());
}

TEST(RewardParameters, FlagsAreInferredGivenOrAnnotated) {
  const std::string source =
      "def compute_reward(x: torch.Tensor, done: torch.Tensor, ok: torch.BoolTensor, kind):\n"
      "    x = torch.where(~done, x, 0.0)\n    return x + ok.float() + kind\n";
  RewardOptions options;
  options.flag_parameters = {"kind"};
  const CompileOutcome outcome = CompileReward(source, nullptr, options);
  ASSERT_TRUE(outcome.program.has_value()) << RenderFinding(outcome.findings[0], source);
  const std::vector<RewardSlot>& slots = outcome.program->slots();
  ASSERT_EQ(slots.size(), 4u);
  EXPECT_FALSE(slots[0].flags);
  for (int i = 1; i < 4; ++i) EXPECT_TRUE(slots[i].flags) << slots[i].part;
  EXPECT_EQ(slots[1].shape, "[N] flags");
}

TEST(RewardParameters, AnAssumedWidthIsSaid) {
  const std::string sum =
      "def compute_reward(dof_pos, default_dof_pos, actions):\n"
      "    return torch.sum((dof_pos - default_dof_pos) ** 2, dim=-1) + actions[:, 11]\n";
  const CompileOutcome free = CompileReward(sum, nullptr);
  ASSERT_TRUE(free.program.has_value());
  ASSERT_EQ(free.findings.size(), 3u);
  EXPECT_EQ(free.findings[0].code, "assumed-width");
  EXPECT_EQ(free.findings[0].severity, core::Severity::kInfo);
  EXPECT_EQ(free.findings[0].place, "1:20");
  EXPECT_NE(free.findings[0].sentence.find("[N, 8]"), std::string::npos);
  EXPECT_NE(free.findings[2].sentence.find("[N, 12]"), std::string::npos);
  const std::string list =
      "def compute_reward(dof_pos, default_dof_pos):\n    d = dof_pos - default_dof_pos\n"
      "    return (d * torch.tensor([1, 2, 3, 4, 5, 6.0])).sum(-1)\n";
  const CompileOutcome known = CompileReward(list, nullptr);
  ASSERT_TRUE(known.program.has_value());
  EXPECT_TRUE(known.findings.empty());
  EXPECT_EQ(known.program->slots()[1].shape, "[N, 6]");
}

TEST(RewardParameters, DefaultsAreTaken) {
  const std::string source =
      "def compute_reward(env, gain: float = 2.0, before: Optional[torch.Tensor] = None):\n"
      "    g = env.get_robot_gripper_pose()\n    assert before is None\n"
      "    return g[:, 0] * gain if before is None else before\n";
  const CompileOutcome outcome = CompileReward(source, nullptr);
  ASSERT_TRUE(outcome.program.has_value()) << RenderFinding(outcome.findings[0], source);
  EXPECT_EQ(outcome.program->slots().size(), 1u);
}

TEST(RewardProgram, WhatAMaskPicksMayBeNothing) {
  const CompileOutcome outcome = CompileReward(
      "def compute_reward(env):\n    g = env.get_robot_gripper_pose()\n"
      "    far = g[:, 0] > 9\n    x = g[:, 1]\n"
      "    return x[far].sum() + x[far].max() + 0 * g[:, 2], x[far].mean() == 0\n",
      nullptr);
  ASSERT_TRUE(outcome.program.has_value());
  RewardWorkspace workspace(*outcome.program, 2);
  const std::vector<float> rows = {1, 2, 3, 4, 5, 6};
  std::vector<float> reward(2);
  std::vector<std::uint8_t> success(2);
  const std::vector<RewardBinding> bindings = {{rows.data()}};
  outcome.program->Run(bindings, 2, &workspace, reward.data(), success.data());
  EXPECT_EQ(reward[1], -std::numeric_limits<float>::infinity());
  EXPECT_EQ(success[1], 0);  // the mean of an empty set is NaN
}

}  // namespace
}  // namespace simwright::reward
