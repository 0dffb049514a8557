#pragma once

#include "core/random.h"
#include "robot/arm.h"

namespace simwright::robot {

// Returns a configuration (J) that is uniform within the joint limits.
inline Eigen::VectorXd RandomPosture(const Arm& arm, core::Rng& rng) {
  Eigen::VectorXd q(arm.size());
  for (int j = 0; j < arm.size(); ++j) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(j)];
    q[j] = core::Uniform(rng, joint.lower, joint.upper);
  }
  return q;
}

}  // namespace simwright::robot
