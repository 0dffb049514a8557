#include "robot/trajectory_points.h"

#include <cmath>
#include <utility>

#include "core/error.h"

namespace simwright::robot {
namespace {

constexpr std::int64_t kNanoseconds = 1000000000;
// 46 days: up to here a double resolves nanoseconds.
constexpr std::int64_t kMostSeconds = 4000000;

}  // namespace

TrajectoryPoint PointAt(double seconds) {
  const std::int64_t all = std::llround(seconds * static_cast<double>(kNanoseconds));
  TrajectoryPoint point;
  point.sec = all / kNanoseconds;
  point.nanosec = all % kNanoseconds;
  return point;
}

void RequireRosTimes(const JointTrajectory& trajectory) {
  std::int64_t before = -1;
  for (const double time : trajectory.times) {
    if (!(time < static_cast<double>(kMostSeconds))) {
      throw core::Error("the trajectory is longer than " + std::to_string(kMostSeconds) + " s",
                        "trajectory");
    }
    const TrajectoryPoint point = PointAt(time);
    const std::int64_t rounded = point.sec * kNanoseconds + point.nanosec;
    if (rounded <= before) {
      throw core::Error("two samples are less than a nanosecond apart", "trajectory");
    }
    before = rounded;
  }
}

TrajectoryPoints::TrajectoryPoints(std::vector<std::string> joints, const std::string& where)
    : joints_(std::move(joints)), where_(where) {
  if (joints_.empty()) throw core::Error("the trajectory names no joints", where_);
  if (joints_.size() > kMostTrajectoryJoints) {
    throw core::Error(
        "the trajectory has more than " + std::to_string(kMostTrajectoryJoints) + " joints",
        where_);
  }
}

void TrajectoryPoints::AddRow(const std::vector<double>& row, const char* name,
                              const std::string& place, Rows* rows) const {
  if (row.size() != joints_.size() && !(row.empty() && rows != &positions_)) {
    throw core::Error("there are " + std::to_string(row.size()) + " " + name + " for " +
                          std::to_string(joints_.size()) + " joints",
                      where_ + ": " + place, "give one for each joint");
  }
  if (times_.empty()) rows->given = !row.empty();
  if (rows->given != !row.empty()) {
    throw core::Error(std::string("some points have ") + name + " and others do not",
                      where_ + ": " + place);
  }
  rows->numbers.insert(rows->numbers.end(), row.begin(), row.end());
}

void TrajectoryPoints::Add(const TrajectoryPoint& point, const std::string& place) {
  if (times_.size() == kMostTrajectorySamples) {
    throw core::Error(
        "the trajectory has more than " + std::to_string(kMostTrajectorySamples) + " samples",
        where_);
  }
  if (point.sec < 0 || point.sec >= kMostSeconds || point.nanosec < 0 ||
      point.nanosec >= kNanoseconds) {
    throw core::Error("its time_from_start is not a valid time", where_ + ": " + place,
                      "sec must be in [0, 4000000), nanosec in [0, 10^9)");
  }
  // A quotient of integers: the same number that was rounded to nanoseconds.
  const double time = static_cast<double>(point.sec * kNanoseconds + point.nanosec) /
                      static_cast<double>(kNanoseconds);
  if (!times_.empty() && !(time > times_.back())) {
    throw core::Error("its time does not exceed the previous one", where_ + ": " + place);
  }
  AddRow(point.positions, "positions", place, &positions_);
  AddRow(point.velocities, "velocities", place, &velocities_);
  AddRow(point.accelerations, "accelerations", place, &accelerations_);
  AddRow(point.effort, "efforts", place, &efforts_);
  times_.push_back(time);
}

Eigen::MatrixXd TrajectoryPoints::MatrixOf(const Rows& rows) const {
  if (!rows.given) return {};
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      rows.numbers.data(), static_cast<Eigen::Index>(times_.size()),
      static_cast<Eigen::Index>(joints_.size()));
}

JointTrajectory TrajectoryPoints::Finish() const {
  JointTrajectory trajectory;
  trajectory.joints = joints_;
  trajectory.times = times_;
  trajectory.positions = MatrixOf(positions_);
  trajectory.velocities = MatrixOf(velocities_);
  trajectory.accelerations = MatrixOf(accelerations_);
  trajectory.efforts = MatrixOf(efforts_);
  RequireWellFormed(trajectory, where_);
  return trajectory;
}

}  // namespace simwright::robot
