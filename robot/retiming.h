#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "robot/arm.h"
#include "robot/joint_limits.h"
#include "robot/joint_trajectory.h"

namespace simwright::robot {

// Joint positions at given times, as recorded by a simulation.
struct RecordedPath {
  std::vector<std::string> joints;  // (J) names; the fingers may be among them
  std::vector<double> times;        // (K) s, increasing, at roughly uniform intervals
  Eigen::MatrixXd positions;        // (K x J) rad or m
  std::vector<double> speed_ups;    // (K) largest speed-up at each position, or empty
};

struct RetimingOptions {
  double rate = 1000.0;               // Hz: 1 kHz as libfranka requires
  double revolute_deviation = 2e-3;   // rad: largest deviation of a revolute joint
  double prismatic_deviation = 5e-4;  // m: largest deviation of a prismatic joint
  double tool_deviation = 1e-3;       // m: largest deviation of the tool, if an arm is given
  double max_revolute_step = 0.2;     // rad between recorded positions: a larger step is a jump
  double max_prismatic_step = 0.05;   // m, the same for a prismatic joint
  double ramp = 0.1;                  // s, duration of the start and stop ramps
  double max_speed_up = 1.0;          // largest speed-up over the recording
  double max_stretch = 50.0;          // largest slow-down over the recording; more is an error

  bool IsValid(std::string* error) const;
};

struct Retimed {
  JointTrajectory trajectory;          // with velocities and accelerations; J joints
  double recorded = 0.0;               // s
  double stretch = 1.0;                // its duration over the recording's
  std::vector<double> waypoint_times;  // (K) s: time of each recorded position
  Eigen::VectorXd deviations;          // (J) rad or m, the largest of each joint at the waypoints
  double tool_deviation = 0.0;         // m, the largest; 0 without an arm
};

// Returns a trajectory that a controller accepts from a recorded one: at rest at both ends, within
// `limits` (J; from CommandLimits for limits that a robot enforces), close to the recording, and as
// fast as the limits, options.max_speed_up and path.speed_ups allow; with the default options it is
// slower than the recording only where the limits require it. One time law serves all joints, so
// that the fingers close at the recorded configuration. `sliding` (J) marks the prismatic joints;
// the tool deviation is measured with `arm`, whose joints are found by name, or not at all if it is
// null. CheckLimits accepts the result. Deviations are measured at the recorded positions, at equal
// path parameters. Throws core::Error, naming joint, time, value and limit, for: a position that is
// not finite or exceeds its limits by more than its allowed deviation; a jump; times that do not
// increase or are uneven; speed_ups that are not positive or not K in number; fewer than 4 or more
// than 500,000 positions; limits that no slow-down within `max_stretch` meets; invalid options.
Retimed Retime(const RecordedPath& path, const std::vector<JointLimits>& limits,
               const std::vector<bool>& sliding, const Arm* arm,
               const RetimingOptions& options = {});

}  // namespace simwright::robot
