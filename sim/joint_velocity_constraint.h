#pragma once

#include <memory>

class btMultiBody;
class btMultiBodyConstraint;

namespace simwright::sim {

// One solver constraint for all that drives or resists a joint: a target velocity within force
// bounds (a motor, or dry friction: target 0 within +-friction), and a damper. It is implicit and
// solved together with the contacts. As separate constraints, damper and friction of a light link
// would take hundreds of iterations to converge.
class JointVelocityConstraint {
 public:
  // `link`: Bullet's index of the joint's child link. `damping`: N m s/rad or N s/m.
  JointVelocityConstraint(btMultiBody* body, int link, double damping);
  ~JointVelocityConstraint();
  JointVelocityConstraint(const JointVelocityConstraint&) = delete;
  JointVelocityConstraint& operator=(const JointVelocityConstraint&) = delete;

  // Sets the target velocity (rad/s or m/s) and the force bounds (N m or N; the lowest is
  // negative).
  void SetTarget(double velocity, double lowest_force, double highest_force);
  btMultiBodyConstraint* constraint() const;

 private:
  class Row;
  std::unique_ptr<Row> row_;
};

}  // namespace simwright::sim
