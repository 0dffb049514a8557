// Shipped policies by the command line: the list, and rollouts on a user's tasks.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "rl/policy_file.h"
#include "tests/workflows/program.h"
#include "tests/workflows/scripted_run.h"
#include "workflows/skills/shipped_skills.h"
#include "workflows/skills/skill_matching.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

using nlohmann::json;

const fs::path kShippedModels = fs::path(SIMWRIGHT_SOURCE_DIR) / "models";

void ExpectOneErrorLine(const std::string& arguments, int code, const std::string& says) {
  const Outcome outcome = RunProgram(arguments + " --quiet");
  EXPECT_EQ(outcome.code, code) << outcome.text;
  EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
  EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
  EXPECT_NE(outcome.text.find(says), std::string::npos) << outcome.text;
}

// The figures are those of the cards, the sizes those of the policies' files.
TEST(ShippedSkillsCommand, ListsEveryPolicyWithItsCard) {
  const Outcome outcome = RunProgram("skills --json", "/dev/null");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const json skills = json::parse(outcome.text).at("skills");
  ASSERT_EQ(skills.size(), SkillSuite().size());
  for (size_t i = 0; i < skills.size(); ++i) {
    const SuiteCell& cell = SkillSuite()[i];
    EXPECT_EQ(skills[i].at("name"), cell.name);
    EXPECT_EQ(skills[i].at("robot"), cell.robot);
    const rl::Policy policy = rl::ReadPolicy(ShippedPolicy(kShippedModels, cell.name));
    EXPECT_EQ(skills[i].at("observation_size"), policy.observation_size());
    EXPECT_EQ(skills[i].at("action_size"), policy.action_size());
    EXPECT_EQ(skills[i].at("success").at("episodes"), 300);
  }
  // models/skills/open_drawer.md: 298 of 300, 99.3 % (97.6-99.8).
  EXPECT_EQ(skills[2].at("success").at("successes"), 298);
  EXPECT_NEAR(skills[2].at("success").at("low"), 0.976, 5e-4);
  EXPECT_NEAR(skills[2].at("success").at("high"), 0.998, 5e-4);
  const std::string table = RunProgram("skills").text;
  EXPECT_NE(table.find(" 99.3 % (97.6 to 99.8)"), std::string::npos) << table;
}

TEST(ShippedSkillsCommand, CardsWithoutAFigureAreNotMeasured) {
  EXPECT_FALSE(SuccessOnCard("").has_value());
  EXPECT_FALSE(SuccessOnCard("| a | 300 of 200 | b |").has_value());
  EXPECT_FALSE(SuccessOnCard("| a | 0 of 0 | b |").has_value());
  EXPECT_EQ(SuccessOnCard("| a | 99 of 100 | b |")->successes, 99);
}

TEST(ShippedSkillsCommand, AMissingFolderIsOneLine) {
  setenv("SIMWRIGHT_MODELS", "/nonexistent", 1);
  ExpectOneErrorLine("skills", 1, "/nonexistent/skills: there are no shipped skills");
  ExpectOneErrorLine("rollout --skill open_drawer", 1, "there are no shipped skills");
  unsetenv("SIMWRIGHT_MODELS");
}

TEST(ShippedSkillsCommand, NamesOfSubtasksSelectTheSkill) {
  tasks::Task task;
  task.assets = {"drawer_unit_1", "my-mug"};
  const auto names = [&](const char* cell, const char* subtask) {
    tasks::Subtask one;
    one.name = subtask;
    return NamesSkill(CellOf(cell), task, one);
  };
  EXPECT_TRUE(names("open_drawer", "open_drawer_unit_1_drawer_3"));
  EXPECT_TRUE(names("open_drawer", "open_drawer_unit_1_drawer"));
  EXPECT_FALSE(names("open_drawer", "close_drawer_unit_1_drawer_3"));
  EXPECT_FALSE(names("open_drawer", "open_drawer_unit_1_drawer_x"));
  EXPECT_FALSE(names("open_drawer", "open_drawer_unit_2_drawer_3"));
  EXPECT_TRUE(names("pick_up_cup", "pick_up_my_mug"));
  EXPECT_FALSE(names("pick_up_cup", "pick_up_my_mug_from_drawer_unit_1"));
  EXPECT_FALSE(names("put_down_cup", "pick_up_my_mug"));
}

// docs/skills.md: 300 of 300; fewer than 36 of 40 would have a probability below 1e-9 at 99 %.
TEST(ShippedSkillsCommand, ActsOnNewInstancesOfItsKind) {
  const Outcome outcome =
      RunProgram("rollout --skill close_microwave_door --episodes 40 --json", "/dev/null");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const json report = json::parse(outcome.text);
  EXPECT_GE(report.at("successes"), 36);
  EXPECT_EQ(report.at("taken").size(), kUnseenInstances);
  EXPECT_EQ(report.at("skill"), "close_microwave_door");
}

class ShippedSkillOn : public ScriptedRuns {
 protected:
  static std::string TaskFile() { return (shared_->path() / "tasks.json").string(); }
  static std::string On(const std::string& skill) {
    return "rollout --skill " + skill + " --on " + TaskFile();
  }
};

// The block is no cup, so that it has to be named. A policy for cups picks up a block of 5 cm.
TEST_F(ShippedSkillOn, ANamedTaskOfAnotherKindIsTried) {
  const std::string pictures = Path("block.png"), poses = Path("block.jsonl");
  const Outcome outcome = RunProgram(On("pick_up_cup") + " --task pick_up_block --episodes 20 " +
                                         "--json --pictures " + pictures + " --poses " + poses,
                                     "/dev/null");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const json report = json::parse(outcome.text);
  EXPECT_GE(report.at("successes"), 10);
  EXPECT_EQ(report.at("taken"), json::parse(R"([{"task": "pick_up_block",
                                                 "subtask": "pick_up_block"}])"));
  EXPECT_GT(fs::file_size(pictures), 1000u);
  EXPECT_GT(fs::file_size(poses), 1000u);
}

TEST_F(ShippedSkillOn, SkippedTasksHaveAReason) {
  const Outcome outcome =
      RunProgram(On("pick_up_cup") + " --task '*' --episodes 4 --json", "/dev/null");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const json report = json::parse(outcome.text);
  const size_t all = tasks::ReadTaskFile(TaskFile()).tasks.size();
  EXPECT_GE(report.at("taken").size(), 1u);
  EXPECT_LE(report.at("taken").size() + report.at("skipped").size(), all + 1);
  for (const json& skipped : report.at("skipped")) {
    EXPECT_FALSE(skipped.at("reason").get<std::string>().empty());
  }
}

TEST_F(ShippedSkillOn, WhatDoesNotFitIsRefusedInOneLine) {
  ExpectOneErrorLine(On("pick_up_cup"), 1, "'block' is of the category");
  ExpectOneErrorLine(On("open_drawer"), 1, "it has pick_up_block, ");
  ExpectOneErrorLine(On("open_drawer") + " --task pick_up_block", 1,
                     "the policy has 70 inputs and 7 outputs, the skill needs 62 and 7");
  ExpectOneErrorLine(On("pick_up_cup") + " --task fly", 1, "there is no task 'fly'");
  ExpectOneErrorLine(On("pick_up_cups"), 1, "choose one of open_microwave_door, ");
}

TEST_F(ShippedSkillOn, ARunOrASkillIsNeeded) {
  ExpectOneErrorLine("rollout", 2, "or --skill NAME is required");
  ExpectOneErrorLine("rollout " + Pick() + " --skill pick_up_cup", 2, "excludes");
  ExpectOneErrorLine("rollout " + Pick() + " --on " + TaskFile(), 2, "--on requires --task");
  ExpectOneErrorLine("rollout --skill pick_up_cup --task pick_up_block", 2, "--on");
}

}  // namespace
}  // namespace simwright::workflows
