#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "robot/joint_trajectory.h"

namespace simwright::robot {

constexpr std::size_t kMostTrajectoryJoints = 64;
constexpr std::size_t kMostTrajectorySamples = 2000000;

// One point of a ROS trajectory as it stands in a file.
struct TrajectoryPoint {
  std::vector<double> positions, velocities, accelerations, effort;
  std::int64_t sec = 0, nanosec = 0;  // time_from_start
};

// A time in whole nanoseconds, as ROS splits it. Requires what RequireRosTimes does.
TrajectoryPoint PointAt(double seconds);

// Throws core::Error where a time is above 4,000,000 s or falls on the one before when both are
// rounded to nanoseconds.
void RequireRosTimes(const JointTrajectory& trajectory);

// Gathers points and makes a trajectory of them. `place` of a point is what an error names.
class TrajectoryPoints {
 public:
  // Throws core::Error where there are too many.
  TrajectoryPoints(std::vector<std::string> joints, const std::string& where);

  // Throws core::Error where a list has neither as many numbers as there are joints nor, but for
  // the positions, none; where the first point had one that this lacks, or the other way round;
  // where the time does not come after the one before; where there are too many.
  void Add(const TrajectoryPoint& point, const std::string& place);
  // Throws core::Error where it has no point.
  JointTrajectory Finish() const;

 private:
  struct Rows {
    std::vector<double> numbers;
    bool given = false;
  };
  void AddRow(const std::vector<double>& row, const char* name, const std::string& place,
              Rows* rows) const;
  Eigen::MatrixXd MatrixOf(const Rows& rows) const;

  std::vector<std::string> joints_;
  std::string where_;
  std::vector<double> times_;
  Rows positions_, velocities_, accelerations_, efforts_;
};

}  // namespace simwright::robot
