#include "tasks/task_file.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/random.h"

namespace simwright::tasks {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

TaskSet SampleSet(const fs::path& folder) {
  TaskSet set;
  set.assets = {{"oven", (folder / "assets" / "oven").string(), "oven"},
                {"cup", (folder.parent_path() / "cups" / "cup.urdf").string(), ""},
                {"far", "/somewhere/else/far", "far thing"},
                {"bare", "", ""}};
  Task task;
  task.name = "T\u00FCr_\u00F6ffnen";
  task.description = "Open \"it\".\nSlowly.";
  task.source = "rules";
  task.assets = {"oven", "cup"};
  task.findings = {{"llm-gave-up", core::Severity::kError, "open", "no use", 2.0}};
  Subtask subtask;
  subtask.name = "open";
  subtask.description = "Pull.";
  subtask.program = "def compute_reward(env):\n\treturn 1, 1  # \u00E4\n\n";
  subtask.success = "it is open";
  subtask.start.world_from_robot.translation() = Eigen::Vector3d(0.1, -0.2, 1e-17);
  subtask.start.world_from_robot.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  subtask.start.placements = {{"oven", Eigen::Isometry3d::Identity(), true},
                              {"cup", subtask.start.world_from_robot, false}};
  subtask.start.joints = {{"oven", "door", 1.0 / 3.0}};
  subtask.start.held = "cup";
  subtask.goal = Eigen::Vector3d(0.3, 0.1, 0.75);
  subtask.findings = {{"sign", core::Severity::kWarning, "1:2", "it is weak", -0.125}};
  subtask.attempts = {{"no line break", {{"x", core::Severity::kInfo, "", "y", 0.0}}}, {"", {}}};
  task.subtasks = {subtask, Subtask()};
  task.subtasks[1].name = "shut";
  set.tasks = {task};
  return set;
}

void ExpectNear(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  EXPECT_LT((a.matrix() - b.matrix()).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(TaskFile, ASetComesBackWhole) {
  const core::TemporaryFolder temporary;
  const fs::path folder = temporary.path() / "tasks";
  fs::create_directory(folder);
  const TaskSet set = SampleSet(folder);
  WriteTaskFile(set, folder / "tasks.json");
  const TaskSet read = ReadTaskFile(folder / "tasks.json");
  ASSERT_EQ(read.assets.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(read.assets[i].name, set.assets[i].name);
    EXPECT_EQ(read.assets[i].path, set.assets[i].path);
    EXPECT_EQ(read.assets[i].category, set.assets[i].category);
  }
  const Task& task = read.tasks.at(0);
  EXPECT_EQ(task.name, set.tasks[0].name);
  EXPECT_EQ(task.description, set.tasks[0].description);
  EXPECT_EQ(task.assets, set.tasks[0].assets);
  EXPECT_EQ(task.findings.at(0).figure, 2.0);
  const Subtask& a = set.tasks[0].subtasks[0];
  const Subtask& b = task.subtasks.at(0);
  EXPECT_EQ(a.program, b.program);
  EXPECT_EQ(a.success, b.success);
  ExpectNear(a.start.world_from_robot, b.start.world_from_robot);
  ExpectNear(a.start.placements[1].world_from_asset, b.start.placements.at(1).world_from_asset);
  EXPECT_TRUE(b.start.placements[0].fixed);
  EXPECT_EQ(b.start.joints.at(0).position, 1.0 / 3.0);
  EXPECT_EQ(b.start.held, "cup");
  EXPECT_EQ(*b.goal, *a.goal);
  EXPECT_EQ(b.findings.at(0).severity, core::Severity::kWarning);
  EXPECT_EQ(b.findings[0].figure, -0.125);
  EXPECT_EQ(b.attempts.at(0).program, "no line break");
  EXPECT_EQ(b.attempts.at(1).program, "");
  EXPECT_FALSE(task.subtasks.at(1).goal.has_value());
}

TEST(TaskFile, TheSameSetGivesTheSameBytesAlsoWhenReadBefore) {
  core::Rng rng(7);
  TaskSet set = SampleSet("/data/tasks");
  for (int i = 0; i < 2000; ++i) {  // rotations of any kind
    AssetPlacement placement{"cup", Eigen::Isometry3d::Identity(), false};
    Eigen::Vector4d q;
    for (int k = 0; k < 4; ++k) q[k] = core::Uniform(rng, -1.0, 1.0);
    placement.world_from_asset.linear() = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
    set.tasks[0].subtasks[0].start.placements.push_back(placement);
  }
  const std::string text = TaskFileText(set, "/data/tasks");
  EXPECT_EQ(text, TaskFileText(set, "/data/tasks"));
  const TaskSet read = ReadTaskFileText(text, "tasks.json", "/data/tasks");
  EXPECT_TRUE(text == TaskFileText(read, "/data/tasks"));  // too long to be shown
}

TEST(TaskFile, PathsMoveWithTheFile) {
  const Json json = Json::parse(TaskFileText(SampleSet("/data/tasks"), "/data/tasks"));
  EXPECT_EQ(json["format"], 1);
  EXPECT_EQ(json["assets"][0]["path"], "assets/oven");
  EXPECT_EQ(json["assets"][1]["path"], "../cups/cup.urdf");
  EXPECT_EQ(json["assets"][2]["path"], "/somewhere/else/far");
  const TaskSet moved = ReadTaskFileText(json.dump(), "tasks.json", "/new/place");
  EXPECT_EQ(moved.assets[0].path, "/new/place/assets/oven");
  EXPECT_EQ(moved.assets[1].path, "/new/cups/cup.urdf");
  const TaskSet here = ReadTaskFileText(json.dump(), "tasks.json", "");
  EXPECT_EQ(here.assets[0].path, "assets/oven");
}

TEST(TaskFile, AFileWithoutAFolderLiesInTheCurrentOne) {
  TaskSet set;
  set.assets = {{"cup", "kitchen/cup", "cup"}};
  EXPECT_EQ(TaskFileText(set, ""), TaskFileText(set, std::filesystem::current_path()));
}

TEST(TaskFile, ProgramsAreLines) {
  const Json json = Json::parse(TaskFileText(SampleSet("/d"), "/d"));
  EXPECT_EQ(json["tasks"][0]["subtasks"][0]["program"],
            Json({"def compute_reward(env):", "\treturn 1, 1  # \u00E4", "", ""}));
  EXPECT_EQ(json["tasks"][0]["subtasks"][1]["program"], Json::array());
}

std::string ErrorOf(const std::string& text) {
  try {
    ReadTaskFileText(text, "tasks.json", "/d");
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

TEST(TaskFile, DamageIsNamedWithItsPlace) {
  const Json good = Json::parse(TaskFileText(SampleSet("/d"), "/d"));
  const auto error_with = [&](const char* pointer, const Json& value) {
    Json json = good;
    json[Json::json_pointer(pointer)] = value;
    return ErrorOf(json.dump());
  };
  const std::pair<const char*, Json> damages[] = {
      {"/assets", 3},
      {"/assets/0/name", "no name"},
      {"/assets/1/name", "oven"},
      {"/assets/0/colour", "red"},
      {"/tasks/0/name", ""},
      {"/tasks/0/assets/0", "mug"},
      {"/tasks/0/subtasks/0/program", "def"},
      {"/tasks/0/subtasks/0/program/1", 7},
      {"/tasks/0/subtasks/1/name", "open"},
      {"/tasks/0/subtasks/0/goal", Json({1, 2})},
      {"/tasks/0/subtasks/0/start/held", "mug"},
      {"/tasks/0/subtasks/0/start/joints/0/position", "wide"},
      {"/tasks/0/subtasks/0/start/placements/0/fixed", 1},
      {"/tasks/0/subtasks/0/start/placements/0/quaternion_wxyz", Json({0, 0, 0, 0})},
      {"/tasks/0/subtasks/0/start/robot/position", Json({0, 0, nullptr})},
      {"/tasks/0/subtasks/0/findings/0/severity", "fatal"}};
  const char* places[] = {"assets: must be an array",
                          "assets[0].name: must be",
                          "assets[1].name: another asset",
                          "assets[0]: 'colour' is not a known member",
                          "tasks[0].name: is empty",
                          "tasks[0].assets[0]: no asset is called 'mug'",
                          "tasks[0].subtasks[0].program: must be an array",
                          "tasks[0].subtasks[0].program[1]: must be a string",
                          "tasks[0].subtasks[1].name: another subtask",
                          "tasks[0].subtasks[0].goal: must be an array of 3 numbers",
                          "tasks[0].subtasks[0].start.held: no asset",
                          "tasks[0].subtasks[0].start.joints[0].position: must be a number",
                          "tasks[0].subtasks[0].start.placements[0].fixed: must be true",
                          "start.placements[0].quaternion_wxyz: must have length 1",
                          "start.robot.position[2]: must be a number",
                          "tasks[0].subtasks[0].findings[0].severity: must be info"};
  for (std::size_t i = 0; i < std::size(damages); ++i) {
    const std::string error = error_with(damages[i].first, damages[i].second);
    EXPECT_EQ(error.rfind("tasks.json: ", 0), 0u) << error;
    EXPECT_NE(error.find(places[i]), std::string::npos) << error;
  }
  Json missing = good;
  missing["tasks"][0].erase("description");
  EXPECT_NE(ErrorOf(missing.dump()).find("tasks[0]: 'description' is missing"), std::string::npos);
}

TEST(TaskFile, WhatIsNoFileOfTasksIsRefused) {
  const std::string text = TaskFileText(SampleSet("/d"), "/d");
  const std::string cut = ErrorOf(text.substr(0, text.size() / 2));
  EXPECT_NE(cut.find("the JSON ends too early, at line "), std::string::npos) << cut;
  EXPECT_NE(ErrorOf("").find("where JSON was expected"), std::string::npos);
  EXPECT_NE(ErrorOf("[1]").find("'format' is missing"), std::string::npos);
  EXPECT_NE(ErrorOf("{\"format\": 2}").find("newer than this program's 1"), std::string::npos);
  EXPECT_NE(ErrorOf("{\"format\": 0}").find("format: must be 1"), std::string::npos);
  EXPECT_NE(ErrorOf("{\"format\": \"1\"}").find("format: must be a number"), std::string::npos);
  EXPECT_NE(ErrorOf(std::string(100000, '[')).find("nested deeper than 64 levels"),
            std::string::npos);
  EXPECT_NE(ErrorOf("{\"format\": 1e999}"), "");
  // Changes the bytes in turn: the reader returns a set or throws core::Error.
  for (std::size_t i = 0; i < text.size(); i += 3) {
    std::string damaged = text;
    damaged[i] = '~';
    ErrorOf(damaged);
  }
}

TEST(TaskFile, NumbersMustBeFinite) {
  TaskSet set = SampleSet("/d");
  set.tasks[0].subtasks[0].start.joints[0].position = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(TaskFileText(set, "/d"), core::Error);
  const core::TemporaryFolder folder;
  EXPECT_THROW(WriteTaskFile(set, folder.path() / "tasks.json"), core::Error);
  EXPECT_FALSE(fs::exists(folder.path() / "tasks.json"));
  EXPECT_THROW(ReadTaskFile(folder.path() / "tasks.json"), core::Error);
}

}  // namespace
}  // namespace simwright::tasks
