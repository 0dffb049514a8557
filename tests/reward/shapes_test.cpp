// Shapes that torch would broadcast to a matrix, above all [N, 1] with [N], are an error at their
// line that names both shapes, whether they come from the scene or from parameters of inferred
// shape. Intended broadcasts are accepted.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "reward/reward_program.h"

namespace simwright::reward {
namespace {

constexpr const char* kHead =
    "def compute_reward(object_pos, goal_pos, actions):\n"
    "    far = torch.norm(object_pos - goal_pos, dim=-1, keepdim=True)\n"  // [N, 1]
    "    gap = object_pos - goal_pos\n"                                    // [N, 3]
    "    effort = torch.sum(actions ** 2, dim=-1)\n";                      // [N]

struct Wrong {
  const char* name;
  const char* line;  // the fifth
  const char* shapes[2];
};

std::ostream& operator<<(std::ostream& out, const Wrong& one) {
  return out << one.name;
}

class RewardShapes : public testing::TestWithParam<Wrong> {};

TEST_P(RewardShapes, AreRefusedAtTheirLineWithBoth) {
  const Wrong& one = GetParam();
  const std::string source = std::string(kHead) + "    " + one.line + "\n    return r\n";
  const CompileOutcome outcome = CompileReward(source, nullptr);
  EXPECT_FALSE(outcome.program.has_value());
  const auto error =
      std::find_if(outcome.findings.begin(), outcome.findings.end(),
                   [](const auto& finding) { return finding.severity == core::Severity::kError; });
  ASSERT_NE(error, outcome.findings.end());
  const core::Finding& finding = *error;
  EXPECT_EQ(finding.place.substr(0, 2), "5:") << RenderFinding(finding, source);
  for (const char* shape : one.shapes) {
    EXPECT_NE(finding.sentence.find(shape), std::string::npos) << finding.sentence;
  }
}

constexpr Wrong kWrong[] = {
    {"Plus", "r = far - 0.01 * effort", {"[N, 1]", "[N]"}},
    {"Swapped", "r = effort + far", {"[N, 1]", "[N]"}},
    {"Times", "r = effort * torch.exp(-far)", {"[N, 1]", "[N]"}},
    {"InPlace", "r = effort.clone(); r += far", {"[N, 1]", "[N]"}},
    {"Unsqueeze", "r = effort.unsqueeze(-1) + effort", {"[N, 1]", "[N]"}},
    {"None", "r = effort[:, None] + effort", {"[N, 1]", "[N]"}},
    {"UnsqueezeFirst", "r = effort.unsqueeze(0) + far", {"[1, N]", "[N, 1]"}},
    {"Vector", "r = gap.abs() - effort", {"[N, 3]", "[N]"}},
    {"VectorPower", "r = -gap ** 2 - effort", {"[N, 3]", "[N]"}},
    {"Where", "r = torch.where(far < 0.1, effort, 0.0)", {"[N, 1]", "[N]"}},
    {"Flags", "r = ((far < 0.1) & (effort < 1.0)).float()", {"[N, 1]", "[N]"}},
    {"Logical", "r = torch.logical_or(far < 0.1, effort < 1.0).float()", {"[N, 1]", "[N]"}},
    {"Maximum", "r = torch.maximum(far, effort)", {"[N, 1]", "[N]"}},
    {"Less", "r = (far < effort).float()", {"[N, 1]", "[N]"}},
    {"Stack", "r = torch.stack([far, effort], dim=-1).sum(-1)", {"[N, 1]", "[N]"}},
    {"CatRanks", "r = torch.cat([far, effort], dim=-1).sum(-1)", {"[N, 1]", "[N]"}},
    {"StackRows", "r = torch.stack([effort, effort]).sum(-1) + effort", {"[2]", "[N]"}},
    {"MeanRow", "r = gap.mean(dim=0) + effort", {"[3]", "[N]"}},
    {"MeanKept", "r = gap.mean(dim=1, keepdim=True) + effort", {"[N, 1]", "[N]"}},
    {"MaxKept", "r = gap.max(dim=-1, keepdim=True).values + effort", {"[N, 1]", "[N]"}},
    {"SumKept", "r = gap.sum(-1, keepdim=True) * effort", {"[N, 1]", "[N]"}},
    {"View", "r = far.view(-1, 1) + effort", {"[N, 1]", "[N]"}},
    {"Transposed", "r = far.T + far", {"[1, N]", "[N, 1]"}},
    {"Slice", "r = gap[:, 2:3] + effort", {"[N, 1]", "[N]"}},
    {"ListIndex", "r = gap[:, [2]] + effort", {"[N, 1]", "[N]"}},
};
INSTANTIATE_TEST_SUITE_P(Broadcast, RewardShapes, testing::ValuesIn(kWrong),
                         [](const auto& one) { return std::string(one.param.name); });

struct Right {
  const char* name;
  const char* line;
};
class RewardShapesTaken : public testing::TestWithParam<Right> {};

TEST_P(RewardShapesTaken, CompileWithTheNamedShapes) {
  const std::string source = std::string(kHead) + "    " + GetParam().line + "\n    return r\n";
  const CompileOutcome outcome = CompileReward(source, nullptr);
  ASSERT_TRUE(outcome.program.has_value()) << source << RenderFinding(outcome.findings[0], source);
  const std::vector<RewardSlot>& slots = outcome.program->slots();
  ASSERT_EQ(slots.size(), 3u);
  EXPECT_EQ(slots[0].shape, "[N, 3]");
  EXPECT_EQ(slots[2].shape, "[N, 8]");
}

constexpr Right kRight[] = {
    {"Squeeze", "r = far.squeeze(-1) - effort"},
    {"SqueezeAll", "r = far.squeeze() - effort"},
    {"View", "r = far.view(-1) - effort"},
    {"Reshape", "r = far.reshape(-1) - effort"},
    {"Flatten", "r = far.flatten() - effort"},
    {"Index", "r = far[:, 0] - effort"},
    {"BothColumns", "r = (far - effort.unsqueeze(-1)).squeeze(-1)"},
    {"ColumnBesideVector", "r = (gap * far).sum(-1) - effort"},
    {"Sum", "r = gap.abs().sum(-1) - effort"},
    {"Stack", "r = torch.stack([far.squeeze(-1), effort], dim=-1).sum(-1)"},
    {"Cat", "r = torch.cat([far, gap], dim=-1).sum(-1) - effort"},
};
INSTANTIATE_TEST_SUITE_P(Broadcast, RewardShapesTaken, testing::ValuesIn(kRight),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(RewardShapesOfTheScene, AreRefusedToo) {
  const std::string source =
      "def compute_reward(env):\n    g = env.get_robot_gripper_pose()\n"
      "    far = torch.norm(g, dim=-1, keepdim=True)\n    return far + g[:, 2]\n";
  const CompileOutcome outcome = CompileReward(source, nullptr);
  ASSERT_FALSE(outcome.findings.empty());
  EXPECT_EQ(outcome.findings[0].place, "4:16");
  EXPECT_EQ(outcome.findings[0].code, "two-batches");
}

// The reward itself: a single column is distinguished from several.
TEST(RewardShapesOfTheReward, AColumnIsToBeSqueezed) {
  const CompileOutcome column = CompileReward(std::string(kHead) + "    return -far\n", nullptr);
  ASSERT_FALSE(column.findings.empty());
  EXPECT_EQ(column.findings[0].code, "bad-reward");
  EXPECT_NE(column.findings[0].sentence.find("[N, 1]; use .squeeze(-1)"), std::string::npos)
      << column.findings[0].sentence;
}

// A reduction with "dim=-1" over one number per environment would give one number for all
// environments.
TEST(RewardShapesOfTheReward, AReductionOverTheEnvironmentsIsSaid) {
  for (const char* sum : {"z.sum(dim=-1)", "torch.mean(z, dim=-1)", "z.max(dim=-1).values"}) {
    const CompileOutcome outcome = CompileReward(
        "def compute_reward(env):\n    z = env.get_robot_gripper_pose()[:, 2]\n    return z - " +
            std::string(sum) + "\n",
        nullptr);
    ASSERT_EQ(outcome.findings.size(), 1u) << sum;
    EXPECT_EQ(outcome.findings[0].code, "reduction-over-environments");
    EXPECT_EQ(outcome.findings[0].place.substr(0, 2), "3:");
  }
}

}  // namespace
}  // namespace simwright::reward
