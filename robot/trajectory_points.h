#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "robot/joint_trajectory.h"

namespace simwright::robot {

constexpr std::size_t kMostTrajectoryJoints = 64;
constexpr std::size_t kMostTrajectorySamples = 2000000;

// One point of a ROS trajectory, as in a file.
struct TrajectoryPoint {
  std::vector<double> positions, velocities, accelerations, effort;
  std::int64_t sec = 0, nanosec = 0;  // time_from_start
};

// Returns a point with the time rounded to nanoseconds and split as ROS does. Requires the
// conditions of RequireRosTimes.
TrajectoryPoint PointAt(double seconds);

// Throws core::Error if a time exceeds 4,000,000 s or equals the previous one after rounding to
// nanoseconds.
void RequireRosTimes(const JointTrajectory& trajectory);

// Collects points and builds a trajectory from them. Errors name the `place` of a point.
class TrajectoryPoints {
 public:
  // Throws core::Error if there are too many joints.
  TrajectoryPoints(std::vector<std::string> joints, const std::string& where);

  // Throws core::Error if a list does not have one number per joint (all lists but the positions
  // may be empty), a list is given in some points only, the time does not exceed the previous one,
  // or there are too many points.
  void Add(const TrajectoryPoint& point, const std::string& place);
  // Throws core::Error if there is no point.
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
