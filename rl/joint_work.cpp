#include "rl/joint_work.h"

#include <cmath>

namespace simwright::rl {

double WorkEnd(const tasks::ThingJoint& joint, double position) {
  const double rest = joint.rest(), most = rest + 0.8 * (joint.far() - rest);
  return std::abs(position - rest) > std::abs(position - most) ? rest : most;
}

}  // namespace simwright::rl
