#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/files.h"
#include "rl/policy_file.h"
#include "skills/skill_evaluation.h"
#include "tasks/task_file.h"
#include "workflows/skills/skill_run.h"
#include "workflows/skills/skill_suite.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

const fs::path kModels = fs::path(SIMWRIGHT_SOURCE_DIR) / "models";

std::vector<std::string> Shipped() {
  std::vector<std::string> names;
  for (const SuiteCell& cell : SkillSuite()) {
    if (fs::exists(ShippedPolicy(kModels, cell.name))) names.push_back(cell.name);
  }
  return names;
}

class ShippedSkill : public testing::TestWithParam<std::string> {};

// Of 300 episodes.
double RateOnCard(const fs::path& card) {
  static const std::regex rate(R"(([0-9.]+) % \()");
  const std::string text = core::ReadFile(card, 1 << 16);
  std::smatch found;
  if (!std::regex_search(text, found, rate)) ADD_FAILURE() << card << " says no rate";
  return found.empty() ? 1.0 : 0.01 * std::stod(found[1]);
}

// The rate on their cards, at most 85 %: with 60 episodes, a result is three standard deviations
// below it in one case of 1000 (85 %: below 70).
TEST_P(ShippedSkill, SucceedsOnAssetsThatItHasNotSeen) {
  const SuiteCell& cell = CellOf(GetParam());
  const fs::path file = ShippedPolicy(kModels, cell.name);
  const fs::path card = fs::path(file).replace_extension(".md");
  ASSERT_TRUE(fs::exists(card)) << "a policy without a card";
  const double rate = std::min(0.85, RateOnCard(card));
  const rl::Policy policy = rl::ReadPolicy(file);
  const core::TemporaryFolder folder;
  core::Progress progress;
  SkillRun run;
  run.robot = cell.robot;
  run.options.action = ActionSpaceOf(policy);
  run.folder = folder.path();
  run.set = tasks::ReadTaskFile(
      MakeCellTasks(cell, kUnseenSeed, 2, fs::path(SIMWRIGHT_SOURCE_DIR) / "examples/coffee.png",
                    folder.path(), &progress));
  const auto skills = PrepareSkills(run);
  const skills::Skill& skill = *skills.front().evaluated;
  const skills::SkillEvaluation found =
      skills::Evaluate(skill, policy, skills::SampleStarts(skill, 60, 5));
  EXPECT_GE(found.successes, 60.0 * rate - 3.1 * std::sqrt(60.0 * rate * (1.0 - rate)))
      << cell.name;
}

INSTANTIATE_TEST_SUITE_P(Suite, ShippedSkill, testing::ValuesIn(Shipped()),
                         [](const auto& info) { return info.param; });

// A policy whose cell was renamed would not be tested.
TEST(ShippedSkills, EachBelongsToACell) {
  size_t files = 0;
  for (const auto& entry : fs::directory_iterator(kModels / "skills")) {
    files += entry.path().extension() == ".pt";
  }
  EXPECT_EQ(files, Shipped().size());
  EXPECT_GE(files, 4u);
}

}  // namespace
}  // namespace simwright::workflows
