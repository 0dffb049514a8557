#include "sim/compact_solver.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>

namespace simwright::sim {
namespace {

// The range of an array (count) outside of which all values are zero.
struct Range {
  int first = 0, count = 0;
};

Range WithoutZeros(const double* values, int count) {
  int first = 0;
  while (first < count && values[first] == 0.0) ++first;
  while (count > first && values[count - 1] == 0.0) --count;
  return {first, count - first};
}

// Uses two sums, so that additions do not wait for each other.
double Dot(const double* a, const double* b, int count) {
  double even = 0.0, odd = 0.0;
  int i = 0;
  for (; i + 1 < count; i += 2) {
    even += a[i] * b[i];
    odd += a[i + 1] * b[i + 1];
  }
  if (i < count) even += a[i] * b[i];
  return even + odd;
}

void AddImpulse(const double* response, double impulse, int count, double* changed) {
  for (int i = 0; i < count; ++i) changed[i] += response[i] * impulse;
}

class CompactSolver : public btMultiBodyConstraintSolver {
 public:
  btScalar solveGroupCacheFriendlySetup(btCollisionObject** bodies, int body_count,
                                        btPersistentManifold** manifolds, int manifold_count,
                                        btTypedConstraint** constraints, int constraint_count,
                                        const btContactSolverInfo& info,
                                        btIDebugDraw* drawer) override;
  // Returns the sum of squared impulse changes, (N s)^2 or (N m s)^2.
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count,
                                btTypedConstraint** constraints, int constraint_count,
                                const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                         const btContactSolverInfo& info) override;

 private:
  // One body's part of a constraint row: `count` numbers from the first non-zero one on.
  struct Side {
    const double* jacobian = nullptr;
    const double* velocity = nullptr;  // velocity changes that the jacobian reads
    const double* response = nullptr;  // to a unit impulse
    double* changed = nullptr;         // the velocities that the impulse changes
    int jacobian_count = 0, response_count = 0;
  };
  struct Row {
    Side a, b;
    double rhs = 0.0, inertia = 0.0, compliance = 0.0;  // from btMultiBodySolverConstraint
    double lower = 0.0, upper = 0.0, impulse = 0.0;
    double friction = 0.0;
    int normal = -1;  // of a friction row: its contact's row in normals_
  };
  struct MovedBody {
    btMultiBody* body = nullptr;
    int first = 0;  // in m_data.m_deltaVelocities
  };

  void Pack(const btMultiBodyConstraintArray& source, std::vector<Row>* rows);
  Side PackSide(btMultiBody* body, int jacobian, int velocity);
  static void WriteBack(const std::vector<Row>& rows, btMultiBodyConstraintArray* target);
  static double UnboundedChange(const Row& row);
  static double Change(double change, Row* row);
  static double Solve(Row* row);
  double SolveSpins();
  // `pressed_only`: like Bullet, keeps the impulse of a rolling friction at contacts without
  // pressure.
  double SolveCones(bool pressed_only, std::vector<Row>* rows);

  std::vector<Row> joints_, normals_, frictions_, rollings_, spins_;
  std::vector<MovedBody> moved_bodies_;
  std::vector<double> before_;  // m_data.m_deltaVelocities before the first iteration
};

CompactSolver::Side CompactSolver::PackSide(btMultiBody* body, int jacobian, int velocity) {
  Side side;
  if (body == nullptr) return side;
  const int numbers = 6 + body->getNumDofs();
  const auto same = [&](const MovedBody& moved) { return moved.body == body; };
  if (std::none_of(moved_bodies_.begin(), moved_bodies_.end(), same)) {
    moved_bodies_.push_back({body, velocity});
  }
  const Range read = WithoutZeros(&m_data.m_jacobians[jacobian], numbers);
  const Range written = WithoutZeros(&m_data.m_deltaVelocitiesUnitImpulse[jacobian], numbers);
  side.jacobian = &m_data.m_jacobians[jacobian] + read.first;
  side.velocity = &m_data.m_deltaVelocities[velocity] + read.first;
  side.jacobian_count = read.count;
  side.response = &m_data.m_deltaVelocitiesUnitImpulse[jacobian] + written.first;
  side.changed = &m_data.m_deltaVelocities[velocity] + written.first;
  side.response_count = written.count;
  return side;
}

void CompactSolver::Pack(const btMultiBodyConstraintArray& source, std::vector<Row>* rows) {
  rows->resize(static_cast<size_t>(source.size()));
  for (int i = 0; i < source.size(); ++i) {
    const btMultiBodySolverConstraint& from = source[i];
    Row& row = (*rows)[static_cast<size_t>(i)];
    row.a = PackSide(from.m_multiBodyA, from.m_jacAindex, from.m_deltaVelAindex);
    row.b = PackSide(from.m_multiBodyB, from.m_jacBindex, from.m_deltaVelBindex);
    row.rhs = from.m_rhs;
    row.inertia = from.m_jacDiagABInv;
    row.compliance = from.m_cfm;
    row.lower = from.m_lowerLimit;
    row.upper = from.m_upperLimit;
    row.impulse = from.m_appliedImpulse;
    row.friction = from.m_friction;
    row.normal = from.m_frictionIndex;
  }
}

void CompactSolver::WriteBack(const std::vector<Row>& rows, btMultiBodyConstraintArray* target) {
  for (int i = 0; i < target->size(); ++i) {
    (*target)[i].m_appliedImpulse = rows[static_cast<size_t>(i)].impulse;
  }
}

btScalar CompactSolver::solveGroupCacheFriendlySetup(
    btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
    int manifold_count, btTypedConstraint** constraints, int constraint_count,
    const btContactSolverInfo& info, btIDebugDraw* drawer) {
  const btScalar result = btMultiBodyConstraintSolver::solveGroupCacheFriendlySetup(
      bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, drawer);
  moved_bodies_.clear();
  Pack(m_multiBodyNonContactConstraints, &joints_);
  Pack(m_multiBodyNormalContactConstraints, &normals_);
  Pack(m_multiBodyFrictionContactConstraints, &frictions_);
  Pack(m_multiBodyTorsionalFrictionContactConstraints, &rollings_);
  Pack(m_multiBodySpinningFrictionContactConstraints, &spins_);
  before_.resize(static_cast<size_t>(m_data.m_deltaVelocities.size()));
  for (size_t i = 0; i < before_.size(); ++i) {
    before_[i] = m_data.m_deltaVelocities[static_cast<int>(i)];
  }
  return result;
}

// Returns the row's unbounded impulse change.
double CompactSolver::UnboundedChange(const Row& row) {
  const double speed = Dot(row.a.jacobian, row.a.velocity, row.a.jacobian_count) +
                       Dot(row.b.jacobian, row.b.velocity, row.b.jacobian_count);
  return row.rhs - row.impulse * row.compliance - speed * row.inertia;
}

// Changes the impulse; returns the square of the change.
double CompactSolver::Change(double change, Row* row) {
  row->impulse += change;
  AddImpulse(row->a.response, change, row->a.response_count, row->a.changed);
  AddImpulse(row->b.response, change, row->b.response_count, row->b.changed);
  return change * change;
}

double CompactSolver::Solve(Row* row) {
  const double impulse = row->impulse + UnboundedChange(*row);
  const double bounded = std::clamp(impulse, row->lower, row->upper);
  const double square = Change(bounded - row->impulse, row);
  row->impulse = bounded;
  return square;
}

double CompactSolver::SolveSpins() {
  double change = 0.0;
  for (Row& row : spins_) {
    const double pressed = normals_[static_cast<size_t>(row.normal)].impulse;
    if (pressed <= 0.0) continue;
    row.upper = row.friction * pressed;
    row.lower = -row.upper;
    change += Solve(&row);
  }
  return change;
}

// Solves pairs of perpendicular rows whose combined impulse stays within the friction cone.
double CompactSolver::SolveCones(bool pressed_only, std::vector<Row>* rows) {
  double change = 0.0;
  for (size_t i = 0; i + 1 < rows->size(); i += 2) {
    Row& first = (*rows)[i];
    Row& second = (*rows)[i + 1];
    const double pressed = std::max(0.0, normals_[static_cast<size_t>(first.normal)].impulse);
    if (pressed_only && pressed == 0.0) continue;
    const double a = first.impulse + UnboundedChange(first);
    const double b = second.impulse + UnboundedChange(second);
    const double length = std::sqrt(a * a + b * b), bound = first.friction * pressed;
    const double share = length > bound ? bound / length : 1.0;
    change += Change(share * a - first.impulse, &first);
    change += Change(share * b - second.impulse, &second);
  }
  return change;
}

btScalar CompactSolver::solveSingleIteration(int iteration, btCollisionObject**, int,
                                             btPersistentManifold**, int, btTypedConstraint**, int,
                                             const btContactSolverInfo&, btIDebugDraw*) {
  double change = 0.0;
  const bool forwards = iteration % 2 == 1;  // as in Bullet: joints from the last one first
  for (size_t i = 0; i < joints_.size(); ++i) {
    change += Solve(&joints_[forwards ? i : joints_.size() - 1 - i]);
  }
  for (Row& row : normals_) change += Solve(&row);
  change += SolveSpins();
  change += SolveCones(true, &rollings_);
  change += SolveCones(false, &frictions_);
  return change;
}

btScalar CompactSolver::solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                                      const btContactSolverInfo& info) {
  WriteBack(joints_, &m_multiBodyNonContactConstraints);
  WriteBack(normals_, &m_multiBodyNormalContactConstraints);
  WriteBack(frictions_, &m_multiBodyFrictionContactConstraints);
  WriteBack(rollings_, &m_multiBodyTorsionalFrictionContactConstraints);
  WriteBack(spins_, &m_multiBodySpinningFrictionContactConstraints);
  for (size_t i = 0; i < before_.size(); ++i) {
    before_[i] = m_data.m_deltaVelocities[static_cast<int>(i)] - before_[i];
  }
  for (const MovedBody& moved : moved_bodies_) {
    moved.body->applyDeltaVeeMultiDof2(&before_[static_cast<size_t>(moved.first)], 1.0);
    moved.body->setPosUpdated(false);
  }
  return btMultiBodyConstraintSolver::solveGroupCacheFriendlyFinish(bodies, body_count, info);
}

}  // namespace

std::unique_ptr<btMultiBodyConstraintSolver> MakeCompactSolver() {
  return std::make_unique<CompactSolver>();
}

}  // namespace simwright::sim
