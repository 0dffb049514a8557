#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace simwright::robot {

// A motion of joints, sampled. N samples of J joints, rad or m and s.
struct JointTrajectory {
  std::vector<std::string> joints;           // (J) names
  std::vector<double> times;                 // (N) s since the start, rising
  Eigen::MatrixXd positions;                 // (N x J)
  Eigen::MatrixXd velocities;                // (N x J), or empty where they are not known
  Eigen::MatrixXd accelerations;             // (N x J), or empty
  Eigen::MatrixXd efforts;                   // (N x J) N m or N, or empty
  std::map<std::string, std::string> notes;  // where it comes from: robot, task, policy, seed

  Eigen::Index size() const { return static_cast<Eigen::Index>(times.size()); }
};

// Throws core::Error, naming `where`, joint and time, unless `trajectory` has a joint and a sample,
// names its joints, each once, matrices of its size, finite numbers, and times that rise from 0 or
// above.
void RequireWhole(const JointTrajectory& trajectory, const std::string& where);

}  // namespace simwright::robot
