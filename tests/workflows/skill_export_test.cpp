// `export`: a scripted skill is rolled out and exported as trajectories or demonstrations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "program.h"
#include "robot/trajectory_file.h"
#include "scripted_run.h"
#include "workflows/skills/skill_export.h"
#include "workflows/skills/skill_motion.h"
#include "workflows/skills/skill_recording.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

class SkillExport : public ScriptedRuns {};

TEST_F(SkillExport, ARecordingHasTheEvaluationsOutcomes) {
  const TrainedTask task(Move());
  const skills::ChainEvaluation evaluation = skills::EvaluateChain(task.links(), 10, 5);
  EXPECT_GE(evaluation.successes, 8);  // the scripted policy is reliable
  for (int i = 0; i < 10; ++i) {
    const ChainRecording recording = RecordEpisode(task.links(), 5, static_cast<std::uint64_t>(i));
    const skills::ChainOutcome& outcome = evaluation.outcomes[static_cast<size_t>(i)];
    EXPECT_EQ(recording.success, outcome.success);
    ASSERT_EQ(recording.subtasks.size(), outcome.links.size());
    for (size_t k = 0; k < outcome.links.size(); ++k) {
      EXPECT_EQ(recording.subtasks[k].success, outcome.links[k].success);
      EXPECT_NEAR(recording.subtasks[k].decisions.size() * 0.05, outcome.links[k].seconds, 1e-9);
    }
  }
}

// Episodes that do not reproduce their task are not written, and are counted.
TEST_F(SkillExport, OthersAreTriedInPlaceOfRecordingsThatAreNotKept) {
  const TrainedTask task(Pick());
  RecordingTally all, some;
  const auto recordings = RecordSuccesses(task.links(), 6, 1, &all);
  const auto odd = RecordSuccesses(task.links(), 3, 1, &some, [](const ChainRecording& recording) {
    return recording.episode % 2 == 1;
  });
  ASSERT_EQ(odd.size(), 3u);
  std::uint64_t last = 0;
  for (const ChainRecording& recording : odd) {
    EXPECT_EQ(recording.episode % 2, 1u);
    EXPECT_GT(recording.episode, last);
    last = recording.episode;
  }
  EXPECT_EQ(some.tried, static_cast<int>(last) + 1);
  EXPECT_GE(some.succeeded, 5);  // of episodes 0 to 5, or more if one of them fails
  EXPECT_EQ(all.succeeded, 6);
  std::string refusal;
  try {
    RecordSuccesses(task.links(), 1, 1, &some, [](const ChainRecording&) { return false; });
  } catch (const core::Error& error) {
    refusal = error.what();
  }
  EXPECT_GE(some.tried, 20);
  EXPECT_NE(refusal.find("0 of them reproduced their task"), std::string::npos) << refusal;
}

// Returns the largest absolute value of the `order`-th differences of a column, over the step to
// that power.
double Largest(const Eigen::VectorXd& column, int order, double step) {
  Eigen::VectorXd difference = column;
  for (int i = 0; i < order; ++i) {
    const Eigen::Index n = difference.size() - 1;
    difference = ((difference.tail(n) - difference.head(n)) / step).eval();
  }
  return difference.cwiseAbs().maxCoeff();
}

// The limits are the manufacturer's, without the retimer's margin.
TEST_F(SkillExport, PositionsAloneKeepTheRobotsLimits) {
  ASSERT_EQ(RunProgram("export --quiet " + Move() + " --format csv -o " + Path("m.csv")).code, 0);
  const robot::JointTrajectory motion = robot::ReadTrajectory(Path("m.csv"));
  const robot::RobotModel& panda = RobotOf("panda");
  ASSERT_EQ(motion.joints.size(), 8u);
  for (Eigen::Index i = 0; i < motion.size(); ++i) {
    EXPECT_NEAR(motion.times[static_cast<size_t>(i)], 1e-3 * static_cast<double>(i), 1e-9);
  }
  for (size_t j = 0; j < motion.joints.size(); ++j) {
    const auto joint =
        std::find_if(panda.urdf.joints.begin(), panda.urdf.joints.end(),
                     [&](const assets::Joint& one) { return one.name == motion.joints[j]; });
    ASSERT_NE(joint, panda.urdf.joints.end()) << motion.joints[j];
    const robot::JointLimits& limits =
        panda.limits[static_cast<size_t>(joint - panda.urdf.joints.begin())];
    const Eigen::VectorXd column = motion.positions.col(static_cast<Eigen::Index>(j));
    EXPECT_GE(column.minCoeff(), joint->lower - 1e-9) << motion.joints[j];
    EXPECT_LE(column.maxCoeff(), joint->upper + 1e-9) << motion.joints[j];
    EXPECT_LE(Largest(column, 1, 1e-3), limits.velocity) << motion.joints[j];
    EXPECT_LE(Largest(column, 2, 1e-3), limits.acceleration) << motion.joints[j];
    EXPECT_LE(Largest(column, 3, 1e-3), limits.jerk) << motion.joints[j];
    EXPECT_LT(std::abs(column[1] - column[0]), 1e-6) << "starts at rest";
    EXPECT_LT(std::abs(column[column.size() - 1] - column[column.size() - 2]), 1e-6);
    EXPECT_GT(column.maxCoeff() - column.minCoeff(), 1e-3) << "and moves";
  }
}

// Between two subtasks the recording jumps from the commanded to the measured position; the motion
// does not.
TEST_F(SkillExport, SubtasksFollowEachOtherAfterARest) {
  const TrainedTask task(Move());
  RecordingTally tally;
  const ChainRecording recording = RecordSuccesses(task.links(), 1, 1, &tally).front();
  const skills::Skill& skill = *task.skills().front().evaluated;
  const SkillMotion motion = MotionOf(recording, skill);
  ASSERT_EQ(motion.subtasks.size(), 2u);
  EXPECT_EQ(motion.subtasks[0].begin, 0.0);
  EXPECT_LE(motion.subtasks[0].end, motion.subtasks[1].begin);
  EXPECT_NEAR(motion.subtasks[1].end, motion.retimed.trajectory.times.back(), 2e-3);
  // The last command of the first subtask, during its last half second.
  const RecordedMoment& last = recording.subtasks[0].moments.back();
  const auto at = static_cast<Eigen::Index>(1000.0 * (motion.subtasks[0].end - 0.2));
  for (Eigen::Index j = 0; j < 7; ++j) {
    EXPECT_NEAR(motion.retimed.trajectory.positions(at, j), last.arm_command[j], 2e-3);
  }
  EXPECT_LE(motion.retimed.tool_deviation, 1e-3);
}

std::string ErrorOf(const ChainRecording& recording, const skills::Skill& skill) {
  try {
    MotionOf(recording, skill);
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

TEST_F(SkillExport, WhatTheRobotCannotDoIsRefusedWithJointTimeAndValue) {
  const TrainedTask task(Pick());
  const skills::Skill& skill = *task.skills().front().evaluated;
  ChainRecording jump = RecordEpisode(task.links(), 1, 0);
  ChainRecording outside = jump;
  jump.subtasks[0].moments[60].arm_command[3] += 0.5;  // at 60 Hz: 1 s
  const std::string jumped = ErrorOf(jump, skill);
  for (const char* part : {"panda_joint4", " 1 s", "jumps by 0.49"}) {
    EXPECT_NE(jumped.find(part), std::string::npos) << jumped;
  }
  for (RecordedMoment& moment : outside.subtasks[0].moments) moment.arm_command[0] = 2.95;
  const std::string refused = ErrorOf(outside, skill);  // the limit is 2.8973
  for (const char* part : {"panda_joint1", "0 s", "2.95", "2.8973"}) {
    EXPECT_NE(refused.find(part), std::string::npos) << refused;
  }
  robot::RobotModel slow = *skill.robot;
  slow.limits[static_cast<size_t>(slow.arm_joints[1])].velocity = 0.024;  // command: 0.0005
  skills::Skill crawling = skill;
  crawling.robot = &slow;
  const std::string crawled = ErrorOf(RecordEpisode(task.links(), 1, 0), crawling);
  for (const char* part : {"panda_joint2", " s needs velocity", "the limit is"}) {
    EXPECT_NE(crawled.find(part), std::string::npos) << crawled;
  }
}

// Returns the words after each name that a Python script printed.
std::vector<std::vector<std::string>> PythonLines(const std::string& file) {
  const std::string command = "/usr/bin/python3 " + std::string(SIMWRIGHT_TEST_DATA) +
                              "/read_skill_demonstrations.py " + file + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  std::array<char, 4096> buffer;
  for (size_t count; (count = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    text.append(buffer.data(), count);
  }
  EXPECT_EQ(pclose(pipe), 0) << text;
  std::vector<std::vector<std::string>> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    lines.emplace_back();
    for (std::string word; words >> word;) lines.back().push_back(word);
  }
  return lines;
}

TEST_F(SkillExport, H5pyReadsDemonstrationsThatEndWhereTheTaskSays) {
  ASSERT_EQ(RunProgram("export --quiet " + Move() + " --format robomimic --episodes 12 -o " +
                       Path("m.hdf5"))
                .code,
            0);
  const auto lines = PythonLines(Path("m.hdf5"));
  ASSERT_EQ(lines.size(), 13u);
  EXPECT_EQ(lines[0][1], "12");
  const SkillRun run = ReadRun(Move());
  const tasks::Subtask& last = run.set.tasks.front().subtasks.back();
  for (size_t i = 1; i < lines.size(); ++i) {
    ASSERT_EQ(lines[i].size(), 5u);
    const Eigen::Vector3d place(std::stod(lines[i][2]), std::stod(lines[i][3]),
                                std::stod(lines[i][4]));
    // The block's frame is 4 cm below its centre, to which the goal refers.
    const Eigen::Vector3d goal = last.start.world_from_robot.inverse() * *last.goal;
    EXPECT_LE((place + Eigen::Vector3d(0.0, 0.0, 0.04) - goal).norm(), 0.035) << lines[i][0];
  }
}

TEST_F(SkillExport, TheSameSeedGivesTheSameBytes) {
  for (const char* name : {"a.yaml", "b.yaml"}) {
    ASSERT_EQ(
        RunProgram("export --quiet " + Pick() + " --seed 4 --format ros2 -o " + Path(name)).code,
        0);
  }
  EXPECT_EQ(core::ReadFile(Path("a.yaml")), core::ReadFile(Path("b.yaml")));
}

TEST_F(SkillExport, TheReportNamesEachJointAndItsMargins) {
  const std::string arguments =
      "export " + Pick() + " --format csv --episodes 3 -o " + Path("three");
  const Outcome table = RunProgram(arguments);
  EXPECT_EQ(table.code, 0) << table.text;
  for (const char* name :
       {"panda_joint1", "panda_joint7", "panda_finger_joint1", "the tool deviates"}) {
    EXPECT_NE(table.text.find(name), std::string::npos) << table.text;
  }
  const Outcome outcome = RunProgram(arguments + " --json --force");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const json report = json::parse(outcome.text);
  EXPECT_EQ(report.at("episodes"), 3);
  ASSERT_EQ(report.at("joints").size(), 8u);
  for (const json& joint : report.at("joints")) {
    for (const char* quantity : {"position", "velocity", "acceleration", "jerk"}) {
      EXPECT_LE(joint.at(quantity).at("share").get<double>(), 1.0 + 1e-9) << joint.dump();
    }
  }
  EXPECT_TRUE(fs::exists(Path("three/episode_0003.csv")));
}

TEST_F(SkillExport, WhatCannotBeWrittenIsSaidInOneLine) {
  fs::create_directories(Path("there"));
  for (const std::string& arguments :
       {"export --quiet " + Pick() + " --format csv -o " + Path("a.yaml"),
        "export --quiet " + Pick() + " --format csv --episodes 2 -o " + Path("a.csv"),
        "export --quiet " + Pick() + " --format csv --episodes 2 -o " + Path("there"),
        "export --quiet " + Path("nowhere") + " --format csv -o " + Path("a.csv"),
        "export --quiet " + Pick() + " --format robomimic -o /nowhere/at/all/a.hdf5"}) {
    const Outcome outcome = RunProgram(arguments);
    EXPECT_EQ(outcome.code, 1) << arguments << "\n" << outcome.text;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
  }
  EXPECT_TRUE(fs::is_empty(Path("there")));
  EXPECT_FALSE(fs::exists(Path("a.csv")));
}

}  // namespace
}  // namespace simwright::workflows
