// Trajectories of a subset of joints, joined again and renamed.
#include "robot/trajectory_joints.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "robot/joint_names.h"

namespace simwright::robot {
namespace {

const std::vector<std::string> kJoints = {"panda_joint1", "panda_joint2", "panda_finger_joint1"};

JointTrajectory TrajectoryJointsSample() {
  JointTrajectory trajectory;
  trajectory.joints = kJoints;
  trajectory.times = {0.0, 0.1};
  trajectory.positions = (Eigen::MatrixXd(2, 3) << 1, 2, 3, 4, 5, 6).finished();
  trajectory.velocities = 10.0 * trajectory.positions;
  trajectory.metadata = {{"task", "pick"}};
  return trajectory;
}

TEST(TrajectoryJoints, PartsJoinToTheWhole) {
  const JointTrajectory whole = TrajectoryJointsSample();
  const JointTrajectory arm = JointsOf(whole, {kJoints[0], kJoints[1]});
  EXPECT_EQ(arm.positions, whole.positions.leftCols(2));
  EXPECT_EQ(arm.accelerations.size(), 0);
  EXPECT_EQ(arm.metadata, whole.metadata);
  JointTrajectory finger = JointsOf(whole, {kJoints[2]});
  EXPECT_EQ(finger.velocities, whole.velocities.rightCols(1));
  const JointTrajectory both = Joined(arm, finger, "finger.yaml");
  EXPECT_EQ(both.joints, whole.joints);
  EXPECT_EQ(both.positions, whole.positions);
  EXPECT_EQ(both.velocities, whole.velocities);
  EXPECT_THROW(Joined(arm, arm, "twice"), core::Error);
  finger.times[1] = 0.2;
  EXPECT_THROW(Joined(arm, finger, "later"), core::Error);
  EXPECT_THROW(JointsOf(whole, {"elbow"}), core::Error);
}

TEST(JointNames, AreThoseOfAPandaAndOfAResearch3) {
  EXPECT_EQ(Renamed(TrajectoryJointsSample(), JointNamesFor("panda", kJoints).names).joints,
            kJoints);
  const JointNames fr3 = JointNamesFor("fr3", kJoints);
  EXPECT_EQ(Renamed(TrajectoryJointsSample(), fr3.names).joints,
            (std::vector<std::string>{"fr3_joint1", "fr3_joint2", "fr3_finger_joint1"}));
  // Its joints have smaller ranges and accelerations than a Panda's: 10 against 15 rad/s^2.
  const JointLimits panda = {-2.8973, 2.8973, 2.175, 15.0, 7500.0, 87.0};
  const JointLimits both = TighterLimits(panda, fr3.limits.at("panda_joint1"));
  EXPECT_EQ(both.upper, 2.7437);
  EXPECT_EQ(both.velocity, 2.175);
  EXPECT_EQ(both.acceleration, 10.0);
  EXPECT_FALSE(fr3.limits.contains("panda_finger_joint1"));
  EXPECT_THROW(JointNamesFor("fr3", {"joint1"}), core::Error);
}

TEST(JointNames, AreReadFromAFile) {
  const core::TemporaryFolder folder;
  const std::string file = folder.path() / "names.json";
  core::WriteFile(file, R"({"panda_joint2": "left/elbow"})");
  EXPECT_EQ(Renamed(TrajectoryJointsSample(), JointNamesFor(file, kJoints).names).joints[1],
            "left/elbow");
  for (const char* text : {"{\"panda_joint2\": \"panda_joint1\"}", "{\"elbow\": \"a\"}", "[1]",
                           "{\"panda_joint2\": 1}", "{\"panda_joint2\": "}) {
    core::WriteFile(file, text);
    EXPECT_THROW(JointNamesFor(file, kJoints), core::Error) << text;
  }
  EXPECT_THROW(JointNamesFor(folder.path() / "none.json", kJoints), core::Error);
}

}  // namespace
}  // namespace simwright::robot
