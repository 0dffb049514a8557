#pragma once

#include <memory>

class btMultiBody;
class btMultiBodyConstraint;

namespace simwright::sim {

// All that resists or drives one joint, as one row: a velocity wished for within bounds of force (a
// motor, or dry friction: wish 0 within +-friction), and a damper. Implicit, and solved along with
// the contacts. As rows of their own, damper and friction of a light link fight each other for
// hundreds of iterations.
class JointVelocityRow {
 public:
  // Of the joint that leads to `link`, Bullet's index. `damping`: N m s/rad or N s/m.
  JointVelocityRow(btMultiBody* body, int link, double damping);
  ~JointVelocityRow();
  JointVelocityRow(const JointVelocityRow&) = delete;
  JointVelocityRow& operator=(const JointVelocityRow&) = delete;

  // rad/s or m/s; N m or N, the lowest negative.
  void Wish(double velocity, double lowest_force, double highest_force);
  btMultiBodyConstraint* constraint() const;

 private:
  class Row;
  std::unique_ptr<Row> row_;
};

}  // namespace simwright::sim
