#include "cli/twin_options.h"

#include <cmath>

namespace simwright::cli {

std::optional<Eigen::Vector3d> RobotBaseFlag::base() const {
  if (numbers.size() != 3) return std::nullopt;
  return Eigen::Vector3d(numbers[0], numbers[1], numbers[2] * M_PI / 180.0);
}

CLI::Option* AddRobotBase(CLI::App* command, RobotBaseFlag* robot) {
  return command
      ->add_option("--base", robot->numbers,
                   "Where the robot's base stands on the twin's table: x, y (m, the camera is "
                   "above 0,0 and looks towards +y) and yaw (degrees), with commas")
      ->delimiter(',')
      ->expected(3)
      ->check(CLI::Range(-1000.0, 1000.0))
      ->default_str("where it reaches most objects");
}

CLI::Option* AddSigmas(CLI::App* command, double* sigmas) {
  return command
      ->add_option("--sigmas", *sigmas,
                   "Range of a twin's objects in training, in standard deviations of their "
                   "positions and yaws, to each side")
      ->check(CLI::Range(0.0, 20.0))
      ->capture_default_str();
}

void AddNoRandomization(CLI::App* command, bool* randomized) {
  command->add_flag_callback(
      "--no-randomization", [randomized] { *randomized = false; },
      "Train with all objects where the task describes them, and with masses and frictions as in "
      "their assets");
}

}  // namespace simwright::cli
