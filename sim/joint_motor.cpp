#include "sim/joint_motor.h"

#include <limits>

namespace simwright::sim {

// The impulse is force dt - damping dt v, with v after the step. Either the target velocity is
// reached (a hard row whose bounds give the damper its share), or the force is at a bound (a
// compliant row); the velocity without this row decides which.
MotorRow MakeMotorRow(const JointMotor& drive, double inertia, double velocity, double dt) {
  const double lowest = drive.lowest_force * dt, highest = drive.highest_force * dt;
  if (drive.damping == 0.0) return {drive.velocity, inertia, 0.0, lowest, highest};
  const double share = drive.damping * dt * drive.velocity;
  const double needed = inertia * (drive.velocity - velocity) + share;
  if (needed >= lowest && needed <= highest) {
    return {drive.velocity, inertia, 0.0, lowest - share, highest - share};
  }
  const double compliance = 1.0 / (drive.damping * dt);
  const double soft = inertia / (1.0 + inertia * compliance);
  constexpr double kUnbounded = std::numeric_limits<float>::max();
  return {(needed > 0.0 ? highest : lowest) * compliance, soft, compliance * soft, -kUnbounded,
          kUnbounded};
}

}  // namespace simwright::sim
