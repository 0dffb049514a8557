#pragma once

#include <memory>

#include "sim/joint_motor.h"

class btMultiBody;
class btMultiBodyConstraint;

namespace simwright::sim {

// A JointMotor as a constraint of Bullet's own solver.
class JointVelocityConstraint {
 public:
  // `link`: Bullet's index of the joint's child link. `drive` must outlive the constraint.
  JointVelocityConstraint(btMultiBody* body, int link, const JointMotor* drive);
  ~JointVelocityConstraint();
  JointVelocityConstraint(const JointVelocityConstraint&) = delete;
  JointVelocityConstraint& operator=(const JointVelocityConstraint&) = delete;

  btMultiBodyConstraint* constraint() const;

 private:
  class Row;
  std::unique_ptr<Row> row_;
};

}  // namespace simwright::sim
