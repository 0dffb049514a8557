#include "robot/trajectory_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "core/random.h"

namespace simwright::robot {
namespace {
namespace fs = std::filesystem;

constexpr const char* kTrajectoryFilePython = "/usr/bin/python3";
constexpr TrajectoryFormat kFormats[] = {TrajectoryFormat::kRosYaml, TrajectoryFormat::kRosJson,
                                         TrajectoryFormat::kCsv};

// Numbers of all sizes and signs, at 1 kHz; at least 5 samples.
JointTrajectory TrajectoryFileSample(Eigen::Index samples = 50, bool efforts = true) {
  core::Rng rng(8);
  JointTrajectory trajectory;
  trajectory.joints = {"panda_joint1", "arm/elbow.2"};
  for (Eigen::Index i = 0; i < samples; ++i) {
    trajectory.times.push_back(static_cast<double>(i) / 1000.0);
  }
  const auto random = [&] {
    Eigen::MatrixXd matrix(samples, 2);
    for (double& value : matrix.reshaped()) {
      value = core::Normal(rng) * std::pow(10.0, core::Uniform(rng, -12.0, 6.0));
    }
    return matrix;
  };
  trajectory.positions = random();
  trajectory.velocities = random();
  trajectory.accelerations = random();
  if (efforts) trajectory.efforts = random();
  trajectory.positions(1, 0) = 0.0;
  trajectory.positions(2, 0) = 1e300;
  trajectory.positions(3, 0) = 5e-324;
  trajectory.positions(4, 0) = -3.0;
  return trajectory;
}

void TrajectoryFileExpectSame(const JointTrajectory& a, const JointTrajectory& b) {
  EXPECT_EQ(a.joints, b.joints);
  EXPECT_EQ(a.times, b.times);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.velocities, b.velocities);
  EXPECT_EQ(a.accelerations, b.accelerations);
  EXPECT_EQ(a.efforts, b.efforts);
}

TEST(TrajectoryFile, ReadsBackEveryBit) {
  const core::TemporaryFolder folder;
  for (const bool efforts : {true, false}) {
    JointTrajectory trajectory = TrajectoryFileSample(50, efforts);
    trajectory.metadata = {{"task", "open the door: slowly"}, {"seed", "7"}};
    for (const char* name : {"a.yaml", "a.yml", "a.json", "a.csv"}) {
      WriteTrajectory(folder.path() / name, trajectory);
      const JointTrajectory read = ReadTrajectory(folder.path() / name);
      TrajectoryFileExpectSame(read, trajectory);
      if (std::string(name) != "a.json") {
        EXPECT_EQ(read.metadata, trajectory.metadata);
      }
    }
  }
}

TEST(TrajectoryFile, TimesOfALongMotionReadBackToo) {
  JointTrajectory trajectory;
  trajectory.joints = {"j"};
  constexpr Eigen::Index kSamples = 30000;
  for (Eigen::Index i = 0; i < kSamples; ++i) {
    trajectory.times.push_back(static_cast<double>(i) / 1000.0);
  }
  trajectory.positions = Eigen::MatrixXd::Zero(kSamples, 1);
  for (const TrajectoryFormat format : kFormats) {
    TrajectoryFileExpectSame(ParseTrajectory(TrajectoryText(trajectory, format), format, "text"),
                             trajectory);
  }
}

// Python's readers read the same numbers, bit for bit.
TEST(TrajectoryFile, PythonReadsTheSame) {
  const core::TemporaryFolder folder;
  const JointTrajectory trajectory = TrajectoryFileSample();
  for (const std::string name : {"a.yaml", "a.json"}) {
    const fs::path file = folder.path() / name, printed = folder.path() / "printed.txt";
    WriteTrajectory(file, trajectory);
    const std::string command = std::string(kTrajectoryFilePython) + " '" + SIMWRIGHT_TEST_DATA +
                                "/read_trajectory.py' '" + file.string() + "' > '" +
                                printed.string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0) << "python3-yaml is missing? " << command;
    std::ifstream in(printed);
    std::string line, word;
    std::getline(in, line);
    EXPECT_EQ(line, "panda_joint1 arm/elbow.2");
    for (Eigen::Index i = 0; i < trajectory.size(); ++i) {
      ASSERT_TRUE(std::getline(in, line));
      std::istringstream words(line);
      words >> word;
      EXPECT_EQ(word, std::to_string(1000000 * i));
      for (const Eigen::MatrixXd* matrix : {&trajectory.positions, &trajectory.velocities,
                                            &trajectory.accelerations, &trajectory.efforts}) {
        for (Eigen::Index j = 0; j < 2; ++j) {
          words >> word;
          EXPECT_EQ(std::strtod(word.c_str(), nullptr), (*matrix)(i, j));
        }
      }
    }
    EXPECT_FALSE(std::getline(in, line));
  }
}

// The format of `ros2 topic echo`.
TEST(TrajectoryFile, ReadsListsOfOneEntryALine) {
  const std::string text =
      "header:\n  stamp:\n    sec: 12\n    nanosec: 5\n  frame_id: ''\n"
      "joint_names:\n- a\n- 'b'\n"
      "points:\n"
      "- positions:\n  - 0.5\n  - -1\n  velocities: []\n  accelerations: []\n  effort: []\n"
      "  time_from_start:\n    sec: 0\n    nanosec: 0\n"
      "- positions:\n  - 1.0\n  - 2.5e-3\n  velocities: []\n  accelerations: []\n  effort: []\n"
      "  time_from_start:\n    sec: 1\n    nanosec: 500000000\n"
      "---\n";
  const JointTrajectory read = ParseTrajectory(text, TrajectoryFormat::kRosYaml, "echo");
  EXPECT_EQ(read.joints, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(read.times, (std::vector<double>{0.0, 1.5}));
  EXPECT_EQ(read.positions(0, 1), -1.0);
  EXPECT_EQ(read.positions(1, 1), 2.5e-3);
  EXPECT_EQ(read.velocities.size(), 0);
}

TEST(TrajectoryFile, RefusesAFileThatIsCutOff) {
  const JointTrajectory trajectory = TrajectoryFileSample(5);
  for (const TrajectoryFormat format : kFormats) {
    const std::string whole = TrajectoryText(trajectory, format);
    // Without the last newline no content is missing.
    for (std::size_t length = 0; length + 1 < whole.size(); ++length) {
      EXPECT_THROW(ParseTrajectory(whole.substr(0, length), format, "cut"), core::Error)
          << static_cast<int>(format) << " cut to " << length << " of " << whole.size();
    }
  }
}

// Returns the error line for `whole` with the first `from` replaced by `to`.
std::string LineAfter(std::string whole, TrajectoryFormat format, const std::string& from,
                      const std::string& to) {
  const std::size_t at = whole.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  whole.replace(at, from.size(), to);
  try {
    ParseTrajectory(whole, format, "file");
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

TEST(TrajectoryFile, RefusesWhatIsNoTrajectory) {
  JointTrajectory small;
  small.joints = {"a", "b"};
  small.times = {0.0, 0.5};
  small.positions = Eigen::MatrixXd::Constant(2, 2, 1.25);
  small.velocities = Eigen::MatrixXd::Constant(2, 2, 7.5);
  for (const TrajectoryFormat format : kFormats) {
    const std::string text = TrajectoryText(small, format);
    EXPECT_EQ(LineAfter(text, format, "1.25", "1.5"), "");
    for (const char* wrong : {"nan", "NaN", "inf", "1e999", "x", "1.2.3", "0x1p3"}) {
      EXPECT_NE(LineAfter(text, format, "1.25", wrong), "") << wrong;
    }
  }
  const auto refuses = [&](TrajectoryFormat format, const std::string& from, const std::string& to,
                           const std::string& word) {
    const std::string line = LineAfter(TrajectoryText(small, format), format, from, to);
    EXPECT_NE(line.find(word), std::string::npos) << from << " -> " << to << ": '" << line << "'";
  };
  using enum TrajectoryFormat;
  refuses(kRosYaml, "- a\n", "- b\n", "two joints are named 'b'");
  refuses(kRosYaml, "[1.25, 1.25]", "[1.25]", "1 positions for 2 joints");
  refuses(kRosYaml, "[7.5, 7.5]", "[]", "some points have velocities");
  refuses(kRosYaml, "nanosec: 500000000", "nanosec: 0", "does not exceed");
  refuses(kRosYaml, "nanosec: 500000000", "nanosec: 5000000000", "not a valid time");
  refuses(kRosYaml, "nanosec: 500000000", "nanosec: 0.5", "must be an integer");
  refuses(kRosYaml, "effort", "torque", "not a member");
  refuses(kRosYaml, "points:", "dots:", "not a member");
  refuses(kRosJson, "[1.25, 1.25]", "[1.25]", "1 positions for 2 joints");
  refuses(kRosJson, "[1.25, 1.25]", "[1.25, null]", "points[0].positions[1]");
  refuses(kRosJson, "500000000", "0", "does not exceed");
  refuses(kRosJson, "\"effort\"", "\"torque\"", "'torque'");
  refuses(kRosJson, "\"points\"", "\"dots\"", "'dots'");
  refuses(kCsv, "\n0.5,", "\n0.0,", "does not exceed");
  refuses(kCsv, "1.25,1.25", "1.25", "cells");
  refuses(kCsv, "velocity.b", "speed.b", "velocity.b");
  refuses(kCsv, "time,", "t,", "'time'");
  refuses(kCsv, "samples: 2", "samples: 3", "announces 3");
}

TEST(TrajectoryFile, RefusesToWriteWhatItCouldNotRead) {
  const JointTrajectory whole = TrajectoryFileSample(5);
  const core::TemporaryFolder folder;
  EXPECT_THROW(WriteTrajectory(folder.path() / "a.txt", whole), core::Error);
  for (const TrajectoryFormat format : kFormats) {
    JointTrajectory wrong = whole;
    wrong.joints[1] = "a, b";
    EXPECT_THROW(TrajectoryText(wrong, format), core::Error);
    wrong = whole;
    wrong.metadata["task"] = "two\nlines";
    EXPECT_THROW(TrajectoryText(wrong, format), core::Error);
    wrong = whole;
    wrong.velocities(1, 1) = std::nan("");
    EXPECT_THROW(TrajectoryText(wrong, format), core::Error);
  }
  // ROS counts nanoseconds, in 32 bits of seconds.
  JointTrajectory dense = whole, late = whole;
  dense.times[1] = 1e-12;
  late.times.back() = 1e12;
  for (const JointTrajectory& wrong : {dense, late}) {
    EXPECT_THROW(TrajectoryText(wrong, TrajectoryFormat::kRosYaml), core::Error);
    EXPECT_THROW(TrajectoryText(wrong, TrajectoryFormat::kRosJson), core::Error);
    EXPECT_NO_THROW(TrajectoryText(wrong, TrajectoryFormat::kCsv));
  }
  JointTrajectory gap = whole;
  gap.velocities.resize(0, 0);
  EXPECT_THROW(TrajectoryText(gap, TrajectoryFormat::kCsv), core::Error);
  TrajectoryFileExpectSame(ParseTrajectory(TrajectoryText(gap, TrajectoryFormat::kRosJson),
                                           TrajectoryFormat::kRosJson, "text"),
                           gap);
}

}  // namespace
}  // namespace simwright::robot
