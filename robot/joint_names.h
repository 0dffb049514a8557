#pragma once

#include <map>
#include <string>
#include <vector>

#include "robot/joint_limits.h"

namespace simwright::robot {

// What a controller calls the joints of a robot, and where it is another robot of the same
// kinematics what that can do.
struct JointNames {
  std::map<std::string, std::string> names;   // the robot's to the controller's
  std::map<std::string, JointLimits> limits;  // by the robot's names; empty where none are known
};

// `which`: "panda" or "fr3" (Franka Research 3: a Panda's kinematics, limits of its own, from the
// manufacturer's specification), else a JSON file: an object of the robot's names, each with the
// controller's. Throws core::Error: a robot that is no Panda for the first two; a file that cannot
// be read, names a joint that the robot lacks, or gives two joints one name.
JointNames JointNamesFor(const std::string& which, const std::vector<std::string>& joints);

// The tighter of both, bound by bound.
JointLimits TighterOf(const JointLimits& a, const JointLimits& b);

}  // namespace simwright::robot
