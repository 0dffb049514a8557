#pragma once

#include <string>
#include <vector>

#include "certificate/motion_plan.h"
#include "robot/joint_trajectory.h"
#include "robot/robot_model.h"

namespace simwright::certificate {

struct TrajectoryOptions {
  double rate = 250.0;          // Hz of the trajectory's samples
  double joint_speed = 1.3;     // rad/s or m/s of the fastest joint on free paths
  double approach_speed = 0.6;  // rad/s of the fastest joint near objects
  double carry_speed = 0.9;     // rad/s of the fastest joint with an object in the gripper
  double rest = 0.15;           // s at rest before and after the fingers move

  bool IsValid(std::string* error) const;
};

// The time at which a phase of the plan ends in the trajectory, s.
struct PhaseTime {
  Phase phase = Phase::kReach;
  double end = 0.0;
};

struct TimedMotion {
  robot::JointTrajectory trajectory;  // the arm's joints and the gripper's first joint
  std::vector<PhaseTime> phases;      // by segment of the plan
};

// Returns the trajectory of a plan, retimed to the robot's limits of velocity, acceleration and
// jerk (robot::Retime) and checked against them as a controller does. Throws core::Error if the
// limits cannot be met.
TimedMotion TrajectoryOf(const MotionPlan& plan, const robot::RobotModel& robot,
                         const TrajectoryOptions& options = {});

}  // namespace simwright::certificate
