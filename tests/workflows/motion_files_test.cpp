// Motions on disk: one message per controller, or one table, and reading back under the robot's
// names.
#include "workflows/skills/motion_files.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "robot/trajectory_file.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

robot::JointTrajectory Sample() {
  robot::JointTrajectory motion;
  motion.joints = {"panda_joint1", "panda_joint2", "panda_finger_joint1"};
  motion.times = {0.0, 0.001, 0.002};
  motion.positions = (Eigen::MatrixXd(3, 3) << 0, 1, 2, 0.1, 1.1, 2.1, 0.3, 1.3, 2.3).finished();
  motion.velocities = 3.0 * motion.positions;
  motion.accelerations = 7.0 * motion.positions;
  motion.metadata = {{"task", "pick"}, {"seed", "4"}};
  return motion;
}

class MotionFiles : public testing::TestWithParam<const char*> {
 protected:
  core::TemporaryFolder folder_;
};

TEST_P(MotionFiles, AreReadBackUnderTheRobotsNames) {
  const fs::path file = folder_.path() / (std::string("pick") + GetParam());
  const robot::JointTrajectory motion = Sample();
  WriteMotion(motion, file, robot::JointNamesFor("fr3", motion.joints));
  const robot::JointTrajectory bare = robot::ReadTrajectory(file);
  const bool table = file.extension() == ".csv";
  EXPECT_EQ(bare.joints.size(), table ? 3u : 2u);
  EXPECT_EQ(bare.joints.front(), "fr3_joint1");
  EXPECT_EQ(fs::exists(GripperBeside(file)), !table);
  const robot::JointTrajectory read = ReadMotion(file);
  EXPECT_EQ(read.joints, motion.joints);
  EXPECT_EQ(read.positions, motion.positions);
  EXPECT_EQ(read.velocities, motion.velocities);
  EXPECT_EQ(read.accelerations, motion.accelerations);
  EXPECT_EQ(read.metadata, motion.metadata);
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    EXPECT_EQ(IsMotionSideFile(entry.path()), entry.path() != file) << entry.path();
  }
}

TEST_P(MotionFiles, SayWhatIsMissing) {
  const fs::path file = folder_.path() / (std::string("pick") + GetParam());
  WriteMotion(Sample(), file);
  if (file.extension() == ".json") {
    fs::remove(MetadataFileBeside(file));
    EXPECT_THROW(ReadMotion(file), core::Error);
  }
  if (file.extension() == ".yaml") {
    fs::remove(GripperBeside(file));
    try {
      ReadMotion(file);
      ADD_FAILURE() << "read without the gripper";
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find("pick.gripper.yaml"), std::string::npos);
    }
    // The gripper's file belongs to another motion.
    robot::JointTrajectory other = Sample();
    other.times[2] = 0.004;
    WriteMotion(other, folder_.path() / "other.yaml");
    fs::rename(folder_.path() / "other.gripper.yaml", GripperBeside(file));
    EXPECT_THROW(ReadMotion(file), core::Error);
  }
}

INSTANTIATE_TEST_SUITE_P(Endings, MotionFiles, testing::Values(".yaml", ".json", ".csv"));

}  // namespace
}  // namespace simwright::workflows
