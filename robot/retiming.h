#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "robot/arm.h"
#include "robot/joint_limits.h"
#include "robot/joint_trajectory.h"

namespace simwright::robot {

// Where joints were at given times: a motion as a simulation recorded it.
struct RecordedPath {
  std::vector<std::string> joints;  // (J) names; the fingers may be among them
  std::vector<double> times;        // (K) s, rising, in steps that are about the same
  Eigen::MatrixXd positions;        // (K x J) rad or m
  std::vector<double> paces;        // (K) times this one's at most, beside RetimingOptions; or none
};

struct RetimingOptions {
  double rate = 1000.0;             // samples a second: 1 kHz as libfranka wants them
  double turning_deviation = 2e-3;  // rad: how far a joint may leave the recording
  double sliding_deviation = 5e-4;  // m: the same of a joint that slides
  double tool_deviation = 1e-3;     // m: and the tool, where an arm is given
  double longest_turn = 0.2;        // rad from one recorded position to the next: more is a jump
  double longest_slide = 0.05;      // m, the same of a joint that slides
  double ramp = 0.1;           // s in which the motion starts and ends, however it was recorded
  double fastest = 1.0;        // times the pace of the recording, at most
  double most_stretch = 50.0;  // times the recording's length: more is a motion that cannot be made

  bool IsValid(std::string* error) const;
};

struct Retimed {
  JointTrajectory trajectory;          // positions, velocities, accelerations; J joints
  double recorded = 0.0;               // s
  double stretch = 1.0;                // its length over the recording's
  std::vector<double> waypoint_times;  // (K) s: when each recorded position is passed
  Eigen::VectorXd deviations;          // (J) rad or m, the largest of each joint at the waypoints
  double tool_deviation = 0.0;         // m, the largest; 0 without an arm
};

// Makes a motion that a controller accepts from one that was recorded: from rest to rest, within
// `limits` (J; CommandLimits for what a robot checks itself), close to the recording, and as fast as
// the limits, options.fastest and path.paces allow: by default slower than the recording only where
// the limits ask for that. One law of time serves all joints, so that fingers
// close where they closed. `sliding` (J) says which joints slide; `arm`, whose joints are found by
// name, is what the tool's deviation is measured by, or null. CheckLimits accepts the result.
// Deviations are those at the recorded positions, at the same place of the path.
// Throws core::Error, naming joint, time, value and limit: a position that is not finite or further
// outside its limits than it may deviate, a jump, times that do not rise or are not even, paces that are not above 0 or not K, less than
// 4 or more than 500,000 positions, limits that no slowing meets within `most_stretch`, options
// that are not valid.
Retimed Retime(const RecordedPath& path, const std::vector<JointLimits>& limits,
               const std::vector<bool>& sliding, const Arm* arm,
               const RetimingOptions& options = {});

}  // namespace simwright::robot
