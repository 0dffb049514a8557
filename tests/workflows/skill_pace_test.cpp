// The speed of exported motions, the contents of their files per controller, and the reproduction
// of their task.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "program.h"
#include "robot/joint_names.h"
#include "robot/trajectory_file.h"
#include "scripted_run.h"
#include "tests/robot/path_optimum.h"
#include "workflows/skills/motion_files.h"
#include "workflows/skills/skill_motion.h"
#include "workflows/skills/skill_recording.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

class SkillPace : public ScriptedRuns {};

TEST_F(SkillPace, AMotionTakesLittleMoreThanTheOptimumWithoutJerk) {
  const TrainedTask task(Pick());
  RecordingTally tally;
  const auto recordings = RecordSuccesses(task.links(), 3, 1, &tally);
  const skills::Skill& skill = *task.skills().front().evaluated;
  const MotionJoints joints = MotionJointsOf(*skill.robot);
  robot::RetimingOptions options;
  options.max_speed_up = 100.0;
  for (const ChainRecording& recording : recordings) {
    const SkillMotion fast = MotionOf(recording, skill, options);
    const robot::JointTrajectory& motion = fast.retimed.trajectory;
    double step = 0.0;
    const Eigen::MatrixXd rows = robot::AlongTheWay(motion, joints.sliding, 3000, &step);
    const double least = robot::LeastSeconds(rows, step, joints.limits);
    EXPECT_LT(motion.times.back(), 1.15 * least);
    EXPECT_LT(motion.times.back(),
              0.9 * MotionOf(recording, skill).retimed.trajectory.times.back());
    // The last command is held while the replay evaluates the success.
    EXPECT_NEAR(fast.subtasks.back().end - motion.times.back(), 2.0 * skill.options.hold_seconds,
                2e-3);
  }
}

TEST_F(SkillPace, TheRecordingsPaceIsKeptWhereItIsAsked) {
  const std::string arguments = "export " + Pick() + " --format csv --json -o ";
  const json fast = json::parse(RunProgram(arguments + Path("fast.csv")).text);
  const json slow = json::parse(RunProgram(arguments + Path("slow.csv") + " --pace recorded").text);
  EXPECT_GE(slow.at("stretch").get<double>(), 1.0);
  EXPECT_LT(fast.at("stretch").get<double>(), slow.at("stretch").get<double>());
  EXPECT_LE(fast.at("mean_seconds").get<double>(), slow.at("mean_seconds").get<double>());
  EXPECT_EQ(slow.at("slowed"), 0);
  const auto faster = [](const json& report) {
    for (const json& finding : report.at("findings")) {
      if (finding.at("code") == "export-faster") return finding.at("figure").get<double>();
    }
    return 1.0;
  };
  EXPECT_EQ(faster(fast), fast.at("least_stretch").get<double>());
  EXPECT_LT(faster(fast), 1.0);
  EXPECT_EQ(faster(slow), 1.0);
  const Outcome replay = RunProgram("replay " + Path("fast.csv") + " " + Path("slow.csv"));
  EXPECT_EQ(replay.code, 0) << replay.text;
}

TEST_F(SkillPace, RosHasAMessageForEachControllerUnderItsNames) {
  for (const std::string ending : {".yaml", ".json"}) {
    const std::string file = Path("fr3" + ending);
    const Outcome outcome =
        RunProgram("export --quiet " + Pick() + " --format ros2 --joint-names fr3 -o " + file);
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const robot::JointTrajectory arm = robot::ReadTrajectory(file);
    const robot::JointTrajectory gripper = robot::ReadTrajectory(GripperBeside(file));
    ASSERT_EQ(arm.joints.size(), 7u);
    EXPECT_EQ(arm.joints.front(), "fr3_joint1");
    EXPECT_EQ(gripper.joints, std::vector<std::string>{"fr3_finger_joint1"});
    EXPECT_EQ(arm.times, gripper.times);
    // An FR3 accelerates at 10 rad/s^2, a Panda's last joints at 20.
    const Eigen::MatrixXd& v = arm.velocities;
    const Eigen::Index n = v.rows() - 1;
    EXPECT_LE((v.bottomRows(n) - v.topRows(n)).cwiseAbs().maxCoeff() / 1e-3, 10.0);
    EXPECT_EQ(ReadMotion(file).joints.front(), "panda_joint1");
    const Outcome replay = RunProgram("replay " + file);
    EXPECT_EQ(replay.code, 0) << replay.text;
    fs::remove(GripperBeside(file));
    const Outcome alone = RunProgram("replay " + file);
    EXPECT_EQ(alone.code, 1);
    EXPECT_NE(alone.text.find("fr3.gripper"), std::string::npos) << alone.text;
  }
}

}  // namespace
}  // namespace simwright::workflows
