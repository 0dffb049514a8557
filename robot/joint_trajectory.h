#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace simwright::robot {

// A sampled joint trajectory: N samples of J joints, in rad or m and s.
struct JointTrajectory {
  std::vector<std::string> joints;              // (J) names
  std::vector<double> times;                    // (N) s since the start, increasing
  Eigen::MatrixXd positions;                    // (N x J)
  Eigen::MatrixXd velocities;                   // (N x J), or empty if unknown
  Eigen::MatrixXd accelerations;                // (N x J), or empty
  Eigen::MatrixXd efforts;                      // (N x J) N m or N, or empty
  std::map<std::string, std::string> metadata;  // robot, task, policy, seed

  Eigen::Index size() const { return static_cast<Eigen::Index>(times.size()); }
};

// Throws core::Error, naming `where`, the joint and the time, unless `trajectory` has at least one
// joint and one sample, distinct joint names, matrices of matching size, finite numbers, and times
// that increase from 0 or above.
void RequireWellFormed(const JointTrajectory& trajectory, const std::string& where);

}  // namespace simwright::robot
