// `simwright grasps`: its file, its picture, and its errors.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "manipulation/grasp_file.h"
#include "program.h"
#include "tasks/task_file.h"
#include "workflows/skills/skill_run.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

// Makes an asset of a kind of the library in `folder` and returns its folder.
std::string AssetOf(const std::string& kind, const fs::path& folder) {
  const Outcome made = RunProgram("library --kind " + kind + " --no-check --quiet -o " +
                                  (folder / "library").string());
  EXPECT_EQ(made.code, 0) << made.text;
  return (folder / "library" / (kind + "_1")).string();
}

void ExpectGraspError(const std::string& arguments, const std::string& says) {
  const Outcome outcome = RunProgram("grasps " + arguments);
  EXPECT_EQ(outcome.code, 1) << outcome.text;
  EXPECT_NE(outcome.text.find(says), std::string::npos) << outcome.text;
}

// Expects that a training of picking up the soap takes it by its 8 grasps unless told otherwise,
// and not if they are another gripper's.
void ExpectSkillsUseGrasps(const std::string& soap, const fs::path& folder) {
  const std::string file = (folder / "tasks.json").string();
  const Outcome made = RunProgram("tasks " + soap + " -o " + file);
  ASSERT_EQ(made.code, 0) << made.text;
  SkillRun run;
  run.folder = folder / "run";
  run.set = ChooseTasks(tasks::ReadTaskFile(file), {"pick_up_soap_1"}, file);
  const std::map<std::string, int> expected = {{"soap_1", 8}};
  EXPECT_EQ(GraspCounts(PrepareSkills(run)), expected);
  WriteRun(run);
  EXPECT_TRUE(ReadRun(run.folder).proved_grasps);
  // A run that does not use grasps stays usable when some are proved later.
  SkillRun above = run;
  above.folder = folder / "above";
  above.proved_grasps = false;
  WriteRun(above);
  const fs::path file_of_grasps = fs::path(soap) / manipulation::kGraspFileName;
  const std::string proved = core::ReadFile(file_of_grasps);
  core::WriteFile(file_of_grasps, proved + " ");
  EXPECT_FALSE(ReadRun(above.folder).proved_grasps);
  EXPECT_THROW(ReadRun(run.folder), core::Error);  // its grasps have changed
  core::WriteFile(file_of_grasps, proved);
  run.proved_grasps = false;
  EXPECT_TRUE(GraspCounts(PrepareSkills(run)).empty());
  EXPECT_THROW(WriteRun(run), core::Error);  // a run resumes with the settings that it began with
  run.proved_grasps = true;
  const fs::path grasps = fs::path(soap) / manipulation::kGraspFileName;
  std::string text = core::ReadFile(grasps);
  for (size_t at = 0; (at = text.find("panda_hand", at)) != std::string::npos; at += 10) {
    text.replace(at, 10, "other_hand");
  }
  core::WriteFile(grasps, text);
  core::Findings findings;
  EXPECT_TRUE(GraspCounts(PrepareSkills(run, &findings)).empty());
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].code, "grasps-other-gripper");
}

TEST(GraspsCommand, WritesProvedGraspsAndPicksWithThem) {
  const core::TemporaryFolder folder;
  const std::string soap = AssetOf("soap", folder.path());
  const Outcome made = RunProgram("grasps " + soap + " --count 8 --json", "/dev/null");
  ASSERT_EQ(made.code, 0) << made.text;
  const core::Json report = core::ParseJson(made.text, "the report");
  EXPECT_EQ(report["assets"][0]["grasps"], 8);
  EXPECT_GE(report["assets"][0]["held_in_both"], 8);
  const manipulation::GraspSet set =
      manipulation::ReadGraspSet(fs::path(soap) / manipulation::kGraspFileName);
  EXPECT_EQ(set.grasps.size(), 8u);
  EXPECT_EQ(set.object, "soap_1");
  EXPECT_TRUE(fs::exists(fs::path(soap) / "grasps.png"));
  ExpectGraspError(soap + " --count 8", "use --force to replace it");
  ExpectGraspError(soap + " -o " + (folder.path() / "a.txt").string(), "is no format of grasps");
  ExpectGraspError(soap + " --gripper hand.urdf", "no such gripper");
  ExpectGraspError(soap + " --format isaac -o " + (folder.path() / "a.json").string(),
                   "let it end in .yaml");
  core::WriteFile(folder.path() / "own.png", "a picture of mine");
  ExpectGraspError(soap + " -o " + (folder.path() / "own.json").string(), "own.png");
  EXPECT_EQ(core::ReadFile(folder.path() / "own.png"), "a picture of mine");
  const Outcome picks = RunProgram("grasps " + soap + " --pick-test 2 --json", "/dev/null");
  ASSERT_EQ(picks.code, 0) << picks.text;
  const core::Json row = core::ParseJson(picks.text, "the picks")["picks"][0];
  EXPECT_EQ(row["with_proved"], 2) << picks.text;
  EXPECT_GE(row["expert_proved"], 1) << picks.text;
  ExpectSkillsUseGrasps(soap, folder.path());
}

TEST(GraspsCommand, WritesProvedGraspsOfHandles) {
  const core::TemporaryFolder folder;
  const std::string box = AssetOf("box_with_lid", folder.path());
  const Outcome made = RunProgram("grasps " + box + " --count 3 --json", "/dev/null");
  ASSERT_EQ(made.code, 0) << made.text;
  const core::Json report = core::ParseJson(made.text, "the report")["assets"][0];
  EXPECT_EQ(report["grasps"], 3);
  ASSERT_EQ(report["joints"].size(), 1u);
  EXPECT_GE(report["joints"][0]["held_in_both"], 3);
  const manipulation::GraspSet set =
      manipulation::ReadGraspSet(fs::path(box) / manipulation::kGraspFileName);
  EXPECT_EQ(set.mesh, "box_with_lid_1.urdf");
  const std::string joint = report["joints"][0]["joint"];
  EXPECT_EQ(manipulation::GraspsOfJoint(set, joint).size(), 3u);
  EXPECT_TRUE(fs::exists(fs::path(box) / "grasps.png"));
  const fs::path yaml = folder.path() / "lid.yaml";
  ASSERT_EQ(RunProgram("grasps " + box + " --count 1 --quiet -o " + yaml.string()).code, 0);
  EXPECT_FALSE(fs::exists(yaml));
  const std::string link = report["joints"][0]["link"];
  EXPECT_TRUE(fs::exists(folder.path() / ("lid_" + link + ".yaml")));
  ExpectGraspError(box + " --count 1 -o " + yaml.string(), "lid_" + link + ".yaml");
}

TEST(GraspsCommand, SaysWhatItCannotGrasp) {
  const core::TemporaryFolder folder;
  ExpectGraspError(AssetOf("board_game_large", folder.path()), "no grasp: ");
  ExpectGraspError(AssetOf("light_switch", folder.path()), "no grasp: no hand moves");
  ExpectGraspError((folder.path() / "nothing").string(), "holds no asset.json");
  // A solid that lacks its last face.
  const std::string book = AssetOf("book", folder.path() / "open");
  const std::string solid = core::ReadFile(fs::path(book) / "solid.obj");
  core::WriteFile(fs::path(book) / "solid.obj", solid.substr(0, solid.rfind("\nf ") + 1));
  ExpectGraspError(book, "is not closed: 3 open edges");
}

}  // namespace
}  // namespace simwright::workflows
