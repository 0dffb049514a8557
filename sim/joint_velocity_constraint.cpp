#include "sim/joint_velocity_constraint.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

namespace simwright::sim {
namespace {

constexpr int kBase = 6;  // numbers of the base before the joints' in Bullet's vectors

// Returns the offset of the body's velocity changes in the solver's vector.
int VelocityIndex(btMultiBody* body, int numbers, btMultiBodyJacobianData* data) {
  if (body->getCompanionId() < 0) {
    body->setCompanionId(data->m_deltaVelocities.size());
    data->m_deltaVelocities.resize(data->m_deltaVelocities.size() + numbers, 0.0);
  }
  return body->getCompanionId();
}

}  // namespace

class JointVelocityConstraint::Row : public btMultiBodyConstraint {
 public:
  Row(btMultiBody* body, int link, const JointMotor* drive);

  void finalizeMultiDof() override;
  int getIslandIdA() const override { return IslandOf(m_linkA); }
  int getIslandIdB() const override { return IslandOf(m_linkB); }
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;
  void debugDraw(btIDebugDraw*) override {}

 private:
  void Fill(double dt, btMultiBodyJacobianData* data, btMultiBodySolverConstraint* row) const;
  int IslandOf(int link) const;

  const JointMotor& drive_;
};

JointVelocityConstraint::Row::Row(btMultiBody* body, int link, const JointMotor* drive)
    : btMultiBodyConstraint(body, nullptr, link, body->getLink(link).m_parent, 1, true,
                            MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR),
      drive_(*drive) {}

void JointVelocityConstraint::Row::finalizeMultiDof() {
  allocateJacobiansMultiDof();
  m_numDofsFinalized = m_jacSizeBoth;
  internalSetAppliedImpulse(0, 0.0);
}

void JointVelocityConstraint::Row::createConstraintRows(btMultiBodyConstraintArray& rows,
                                                        btMultiBodyJacobianData& data,
                                                        const btContactSolverInfo& info) {
  if (m_numDofsFinalized != m_jacSizeBoth) finalizeMultiDof();
  if (drive_.lowest_force == 0.0 && drive_.highest_force == 0.0 && drive_.damping == 0.0) return;
  btMultiBodySolverConstraint& row = rows.expandNonInitializing();
  Fill(info.m_timeStep, &data, &row);
}

// Does the same as btMultiBodyConstraint::fillMultiBodyConstraint for one side. Bullet's own motors
// have the same body on both sides; the second side is all zeros and doubles the cost.
void JointVelocityConstraint::Row::Fill(double dt, btMultiBodyJacobianData* data,
                                        btMultiBodySolverConstraint* row) const {
  const int numbers = kBase + m_bodyA->getNumDofs();
  const int own = kBase + m_bodyA->getLink(m_linkA).m_dofOffset;
  *row = btMultiBodySolverConstraint();
  row->m_multiBodyA = m_bodyA;
  row->m_linkA = m_linkA;
  row->m_deltaVelAindex = VelocityIndex(m_bodyA, numbers, data);
  row->m_jacAindex = data->m_jacobians.size();
  data->m_jacobians.resize(row->m_jacAindex + numbers, 0.0);
  data->m_deltaVelocitiesUnitImpulse.resize(row->m_jacAindex + numbers, 0.0);
  data->m_jacobians[row->m_jacAindex + own] = 1.0;
  btScalar* response = &data->m_deltaVelocitiesUnitImpulse[row->m_jacAindex];
  m_bodyA->calcAccelerationDeltasMultiDof(&data->m_jacobians[row->m_jacAindex], response,
                                          data->scratch_r, data->scratch_v);
  const double inertia = response[own] > SIMD_EPSILON ? 1.0 / response[own] : 0.0;
  const double velocity = m_bodyA->getVelocityVector()[own];
  const MotorRow drive = MakeMotorRow(drive_, inertia, velocity, dt);
  row->m_jacDiagABInv = drive.inertia;
  row->m_rhs = (drive.target - velocity) * drive.inertia;
  row->m_cfm = drive.compliance;
  row->m_rhsPenetration = row->m_friction = 0.0;
  row->m_appliedImpulse = row->m_appliedPushImpulse = 0.0;
  row->m_lowerLimit = drive.lower;
  row->m_upperLimit = drive.upper;
  const btVector3 none(0, 0, 0);
  row->m_contactNormal1 = row->m_contactNormal2 = none;
  row->m_relpos1CrossNormal = row->m_relpos2CrossNormal = none;
  row->m_orgConstraint = const_cast<Row*>(this);  // Bullet writes the impulse back
  row->m_orgDofIndex = 0;
}

int JointVelocityConstraint::Row::IslandOf(int link) const {
  const btMultiBodyLinkCollider* collider =
      link < 0 ? m_bodyA->getBaseCollider() : m_bodyA->getLinkCollider(link);
  return collider == nullptr ? -1 : collider->getIslandTag();
}

JointVelocityConstraint::JointVelocityConstraint(btMultiBody* body, int link,
                                                 const JointMotor* drive)
    : row_(std::make_unique<Row>(body, link, drive)) {}

JointVelocityConstraint::~JointVelocityConstraint() = default;

btMultiBodyConstraint* JointVelocityConstraint::constraint() const {
  return row_.get();
}

}  // namespace simwright::sim
