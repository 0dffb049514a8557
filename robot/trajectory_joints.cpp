#include "robot/trajectory_joints.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::robot {
namespace {

constexpr double kTimeSlack = 1e-9;  // s: ROS rounds to nanoseconds

using Matrices = std::vector<Eigen::MatrixXd JointTrajectory::*>;

const Matrices& AllMatrices() {
  static const Matrices matrices = {&JointTrajectory::positions, &JointTrajectory::velocities,
                                    &JointTrajectory::accelerations, &JointTrajectory::efforts};
  return matrices;
}

}  // namespace

JointTrajectory JointsOf(const JointTrajectory& trajectory,
                         const std::vector<std::string>& joints) {
  std::vector<Eigen::Index> columns;
  for (const std::string& joint : joints) {
    const auto found = std::find(trajectory.joints.begin(), trajectory.joints.end(), joint);
    if (found == trajectory.joints.end()) {
      throw core::Error("the motion lacks the joint '" + joint + "'", "trajectory");
    }
    columns.push_back(found - trajectory.joints.begin());
  }
  JointTrajectory part;
  part.joints = joints;
  part.times = trajectory.times;
  part.metadata = trajectory.metadata;
  for (const auto matrix : AllMatrices()) {
    if ((trajectory.*matrix).size() == 0) continue;
    (part.*matrix).resize(trajectory.size(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t j = 0; j < columns.size(); ++j) {
      (part.*matrix).col(static_cast<Eigen::Index>(j)) = (trajectory.*matrix).col(columns[j]);
    }
  }
  return part;
}

JointTrajectory Joined(const JointTrajectory& first, const JointTrajectory& second,
                       const std::string& where) {
  bool same = first.size() == second.size();
  for (std::size_t i = 0; same && i < first.times.size(); ++i) {
    same = std::abs(first.times[i] - second.times[i]) <= kTimeSlack;
  }
  if (!same) {
    throw core::Error("its times differ from those of the arm's file", where, "export it again");
  }
  JointTrajectory both = first;
  both.joints.insert(both.joints.end(), second.joints.begin(), second.joints.end());
  for (const auto matrix : AllMatrices()) {
    if ((first.*matrix).size() == 0 || (second.*matrix).size() == 0) {
      (both.*matrix).resize(0, 0);
      continue;
    }
    (both.*matrix).resize(first.size(), (first.*matrix).cols() + (second.*matrix).cols());
    (both.*matrix) << first.*matrix, second.*matrix;
  }
  RequireWellFormed(both, where);
  return both;
}

JointTrajectory Renamed(const JointTrajectory& trajectory,
                        const std::map<std::string, std::string>& names) {
  JointTrajectory renamed = trajectory;
  for (std::string& joint : renamed.joints) {
    const auto found = names.find(joint);
    if (found != names.end()) joint = found->second;
  }
  RequireWellFormed(renamed, "joint names");
  return renamed;
}

}  // namespace simwright::robot
