#pragma once

#include <map>
#include <string>
#include <vector>

#include "robot/joint_limits.h"

namespace simwright::robot {

// The names that a controller uses for a robot's joints and, if the controller drives another robot
// of the same kinematics, the limits of that robot.
struct JointNames {
  std::map<std::string, std::string> names;   // robot name to controller name
  std::map<std::string, JointLimits> limits;  // by robot name; empty if unknown
};

// Returns the joint names for `which`: "panda" or "fr3" (Franka Research 3: a Panda's kinematics
// with its own limits, from the manufacturer's specification), otherwise a JSON file: an object
// that maps the robot's names to the controller's. Throws core::Error if the robot is not a Panda
// for "panda" or "fr3", or if the file cannot be read, names a joint that the robot lacks, or gives
// two joints one name.
JointNames JointNamesFor(const std::string& which, const std::vector<std::string>& joints);

// Returns the tighter of the two limits, bound by bound.
JointLimits TighterLimits(const JointLimits& a, const JointLimits& b);

}  // namespace simwright::robot
