#include "manipulation/joint_target.h"

#include <cmath>

namespace simwright::manipulation {

double JointTarget(const tasks::ObjectJoint& joint, double position) {
  const double rest = joint.rest(), most = rest + 0.8 * (joint.far() - rest);
  return std::abs(position - rest) > std::abs(position - most) ? rest : most;
}

}  // namespace simwright::manipulation
