// `replay`: exported files reproduce their task on their own, and modified ones do not.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "program.h"
#include "robot/trajectory_file.h"
#include "scripted_run.h"
#include "workflows/skills/motion_files.h"
#include "workflows/skills/skill_export.h"
#include "workflows/skills/skill_metadata.h"
#include "workflows/skills/trajectory_replay.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

class SkillReplay : public ScriptedRuns {
 protected:
  // Writes `episodes` episodes of `run` and replays them, all of which must succeed; the name of
  // the file or folder determines the format.
  void ExpectRepeated(const std::string& run, const std::string& format, const std::string& name,
                      int episodes) {
    const Outcome exported =
        RunProgram("export --json " + run + " --format " + format + " --episodes " +
                   std::to_string(episodes) + " -o " + Path(name));
    ASSERT_EQ(exported.code, 0) << exported.text;
    const json written = json::parse(exported.text);
    EXPECT_EQ(written.at("episodes"), episodes);
    EXPECT_EQ(written.at("succeeded").get<int>() - written.at("left_out").get<int>(), episodes);
    const bool said = std::any_of(
        written.at("findings").begin(), written.at("findings").end(),
        [](const json& finding) { return finding.at("code") == "export-not-reproduced"; });
    EXPECT_EQ(said, written.at("left_out") != 0) << exported.text;
    const Outcome replayed = RunProgram("replay --json " + Path(name));
    ASSERT_EQ(replayed.code, 0) << replayed.text;
    const json report = json::parse(replayed.text);
    EXPECT_EQ(report.at("episodes"), episodes);
    EXPECT_EQ(report.at("successes"), episodes) << replayed.text;
  }
  robot::JointTrajectory ExportedPick() {
    const Outcome outcome =
        RunProgram("export --quiet " + Pick() + " --format csv -o " + Path("pick.csv"));
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    return robot::ReadTrajectory(Path("pick.csv"));
  }
};

TEST_F(SkillReplay, EachFormatDoesTheTaskAgain) {
  ExpectRepeated(Pick(), "ros2", "pick", 6);
  ExpectRepeated(Pick(), "csv", "pick.csv", 1);
  ExpectRepeated(Pick(), "ros2", "pick.json", 1);
  ExpectRepeated(Pick(), "robomimic", "pick.hdf5", 6);
}

// A replay does not correct a block that was released after slipping slightly on its longer path:
// the trajectory rests between the subtasks, the rollout does not. Episodes that fail for this
// reason are not written.
TEST_F(SkillReplay, AChainOfSubtasksDoesToo) {
  ExpectRepeated(Move(), "csv", "move", 20);
  ExpectRepeated(Move(), "robomimic", "move.hdf5", 20);
}

// Modified files must fail: a replay that always succeeds proves nothing.
TEST_F(SkillReplay, AnotherMotionFails) {
  const robot::JointTrajectory motion = ExportedPick();
  const std::vector<RunSkill> skills = PrepareSkills(AtPhysicsRate(ReadRun(Pick())));
  const SkillMetadata notes = MetadataFrom(motion.metadata, "pick.csv");
  EXPECT_EQ(ReplayTrajectory(skills, motion, notes, "a"), std::vector<bool>{true});

  robot::JointTrajectory open = motion;  // never closes the gripper
  open.positions.col(7).setConstant(0.04);
  EXPECT_EQ(ReplayTrajectory(skills, open, notes, "a"), std::vector<bool>{false});

  robot::JointTrajectory beside = motion;  // 0.15 rad is about 8 cm at the block
  beside.positions.col(0).array() += 0.15;
  EXPECT_EQ(ReplayTrajectory(skills, beside, notes, "a"), std::vector<bool>{false});

  SkillMetadata moved = notes;  // the block stands elsewhere
  json start = json::parse(notes.start);
  start["roots"][0][3] = start["roots"][0][3].get<double>() - 0.1;
  moved.start = start.dump();
  EXPECT_EQ(ReplayTrajectory(skills, motion, moved, "a"), std::vector<bool>{false});
}

TEST_F(SkillReplay, AFileThatDoesNotFitIsRefusedInOneLine) {
  robot::JointTrajectory motion = ExportedPick();
  const auto write = [&](const std::string& name, const auto& change) {
    robot::JointTrajectory other = motion;
    change(&other);
    robot::WriteTrajectory(Path(name), other);
    return Path(name);
  };
  const std::string whole = core::ReadFile(Path("pick.csv"));
  core::WriteFile(Path("cut.csv"), whole.substr(0, whole.size() / 2));
  core::WriteFile(Path("noise.hdf5"), "no HDF5");
  const Outcome json_file =
      RunProgram("export --quiet " + Pick() + " --format ros2 -o " + Path("alone.json"));
  ASSERT_EQ(json_file.code, 0);
  fs::remove(MetadataFileBeside(Path("alone.json")));
  using Trajectory = robot::JointTrajectory;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {Path("nowhere.csv"), ""},
      {Path("cut.csv"), ""},
      {Path("noise.hdf5"), ""},
      {Path("alone.json"), "alone.notes.json"},
      {Path("pick.csv") + " --run " + Move(), "task 'pick_up_block'"},
      {Path("pick.csv") + " --run " + Path("nowhere"), "does not exist"},
      {write("arm.csv", [](Trajectory* t) { t->joints[2] = "elbow"; }), "panda_joint3"},
      {write("robot.csv", [](Trajectory* t) { t->metadata["robot"] = "generic6"; }), "generic6"},
      {write("asset.csv", [](Trajectory* t) { t->metadata["assets"] = "[\"00\"]"; }), "changed"},
      {write("start.csv", [](Trajectory* t) { t->metadata["start"] = "{}"; }), "start"},
      {write("none.csv", [](Trajectory* t) { t->metadata.clear(); }), "lacks the metadata entry"},
      {write("times.csv",
             [](Trajectory* t) {
               t->metadata["subtasks"] = R"([{"name":"pick_up_block","begin":0,"end":1e300}])";
             }),
       "is truncated"},
  };
  for (const auto& [arguments, word] : cases) {
    const Outcome outcome = RunProgram("replay --quiet " + arguments);
    EXPECT_EQ(outcome.code, 1) << arguments << "\n" << outcome.text;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find(word), std::string::npos) << arguments << "\n" << outcome.text;
  }
}

}  // namespace
}  // namespace simwright::workflows
