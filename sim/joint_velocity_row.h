#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

namespace simwright::sim {

// All that resists or drives one joint, as one row: a velocity wished for within bounds of force (a
// motor, or dry friction: wish 0 within +-friction), and a damper. Implicit, and solved along with
// the contacts. As rows of their own, damper and friction of a light link fight each other for
// hundreds of iterations.
class JointVelocityRow : public btMultiBodyConstraint {
 public:
  // Of the joint that leads to `link`, Bullet's index. `damping`: N m s/rad or N s/m.
  JointVelocityRow(btMultiBody* body, int link, double damping);

  // rad/s or m/s; N m or N, the lowest negative.
  void Wish(double velocity, double lowest_force, double highest_force) {
    velocity_ = velocity;
    lowest_ = lowest_force;
    highest_ = highest_force;
  }

  void finalizeMultiDof() override;
  int getIslandIdA() const override { return IslandOf(m_linkA); }
  int getIslandIdB() const override { return IslandOf(m_linkB); }
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;
  void debugDraw(btIDebugDraw*) override {}

 private:
  void Fill(double dt, btMultiBodyJacobianData* data, btMultiBodySolverConstraint* row) const;
  void AddDamping(double dt, btMultiBodySolverConstraint* row) const;
  int IslandOf(int link) const;

  double velocity_ = 0.0;
  double lowest_ = 0.0, highest_ = 0.0;  // N m or N
  double damping_ = 0.0;                 // N m s/rad or N s/m
};

}  // namespace simwright::sim
