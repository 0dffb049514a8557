#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "cli/command.h"

namespace simwright::cli {

// The value of --base: x, y (m, the twin's frame) and yaw (degrees).
struct RobotBaseFlag {
  std::vector<double> numbers;

  // Returns x, y (m) and yaw (rad); none if the flag is not given.
  std::optional<Eigen::Vector3d> base() const;
};

// Add the flags of commands that work in a twin: --base, --sigmas and --no-randomization. The
// initial value of `sigmas` is its default; the variables must outlive `command`.
CLI::Option* AddRobotBase(CLI::App* command, RobotBaseFlag* robot);
CLI::Option* AddSigmas(CLI::App* command, double* sigmas);
void AddNoRandomization(CLI::App* command, bool* randomized);

}  // namespace simwright::cli
