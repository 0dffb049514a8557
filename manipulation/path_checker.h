#pragma once

#include "robot/chain_kinematics.h"

namespace simwright::manipulation {

// The collision checks that planners of joint paths need. (J) rad or m.
class PathChecker {
 public:
  virtual ~PathChecker() = default;
  virtual bool IsConfigurationFree(const robot::JointVector& arm) const = 0;
  // Returns true if the straight joint-space segment is collision-free, its end included.
  virtual bool IsPathCollisionFree(const robot::JointVector& from,
                                   const robot::JointVector& to) const = 0;
};

}  // namespace simwright::manipulation
