#include "sim/compact_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include "core/lanes.h"

namespace simwright::sim {
namespace {

constexpr double kWarmShare = 0.85;  // of the last step's impulse
constexpr double kRecovery = 0.2;    // the share of a position error that one step corrects
// rad or m: a joint that is farther beyond its limit returns no faster. Bullet leaves it there, so
// that a knob that strong fingers forced past its stop stays outside of its range.
constexpr double kDeepest = 0.04;
constexpr double kLargestLimit = 100.0;  // N m s or N s, the impulse of a joint limit

double Bounded(double value, double lower, double upper) {
  return value < lower ? lower : value > upper ? upper : value;
}

// Solves pairs of perpendicular rows whose combined impulse stays within the friction cone.
// `pressed_only`: like Bullet, keeps the impulse of a rolling friction at contacts without
// pressure.
__attribute__((always_inline)) inline void SolveCones(const std::vector<ConstraintRow>& normals,
                                                      bool pressed_only,
                                                      std::vector<ConstraintRow>* rows) {
  for (size_t i = 0; i + 1 < rows->size(); i += 2) {
    ConstraintRow& first = (*rows)[i];
    ConstraintRow& second = (*rows)[i + 1];
    const double pressed = std::max(0.0, normals[static_cast<size_t>(first.normal)].impulse);
    if (pressed_only && pressed == 0.0) continue;
    const auto goal = [](const ConstraintRow& row) __attribute__((always_inline)) {
      const double speed = Speed(row.a) + Speed(row.b);
      return row.impulse + (row.target - speed) * row.inertia - row.impulse * row.compliance;
    };
    const double a = goal(first), b = goal(second);
    const double bound = first.friction * pressed;
    const double square = a * a + b * b;
    const double share = square > bound * bound ? bound / std::sqrt(square) : 1.0;
    const double change_a = share * a - first.impulse, change_b = share * b - second.impulse;
    first.impulse = share * a;
    second.impulse = share * b;
    if (change_a != 0.0) {
      Apply(first.a, change_a);
      Apply(first.b, change_a);
    }
    if (change_b != 0.0) {
      Apply(second.a, change_b);
      Apply(second.b, change_b);
    }
  }
}

__attribute__((always_inline)) inline void Solve(ConstraintRow* row) {
  const double speed = Speed(row->a) + Speed(row->b);
  const double impulse =
      Bounded(row->impulse + (row->target - speed) * row->inertia - row->impulse * row->compliance,
              row->lower, row->upper);
  const double change = impulse - row->impulse;
  if (change == 0.0) return;
  row->impulse = impulse;
  Apply(row->a, change);
  Apply(row->b, change);
}

}  // namespace

CompactSolver::JointRow CompactSolver::RowOf(int link, TreeDynamics* dynamics, double* kept) {
  JointRow row;
  const int coordinate = dynamics->Coordinate(link);
  const Span reach = dynamics->Reach(link);
  row.velocity = dynamics->velocity() + coordinate;
  row.changed = dynamics->velocity() + reach.first;
  row.response = dynamics->InverseInertia(coordinate) + reach.first;
  row.count = reach.count;
  const double mobility = dynamics->InverseInertia(coordinate)[coordinate];
  row.inertia = mobility > std::numeric_limits<double>::epsilon() ? 1.0 / mobility : 0.0;
  row.impulse = kWarmShare * *kept;
  row.kept = kept;
  return row;
}

void CompactSolver::AddMotor(double dt, TreeDynamics* dynamics, SolverJoint* joint) {
  const JointMotor& motor = *joint->motor;
  if (motor.lowest_force == 0.0 && motor.highest_force == 0.0 && motor.damping == 0.0) {
    joint->motor_impulse = 0.0;
    return;
  }
  JointRow row = RowOf(joint->link, dynamics, &joint->motor_impulse);
  const MotorRow made = MakeMotorRow(motor, row.inertia, *row.velocity, dt);
  row.target = made.target;
  row.inertia = made.inertia;
  row.compliance = made.compliance;
  row.lower = made.lower;
  row.upper = made.upper;
  joints_.push_back(row);
}

void CompactSolver::AddLimits(double dt, TreeDynamics* dynamics, SolverJoint* joint) {
  const double position = dynamics->JointPosition(joint->link);
  for (const int side : {0, 1}) {
    const double distance = side == 0 ? position - joint->lower : joint->upper - position;
    if (distance > 0.0) {
      joint->limit_impulses[side] = 0.0;
      continue;
    }
    JointRow row = RowOf(joint->link, dynamics, &joint->limit_impulses[side]);
    row.sign = side == 0 ? 1.0 : -1.0;
    row.target = std::min(-distance, kDeepest) * kRecovery / dt;
    row.upper = kLargestLimit;
    joints_.push_back(row);
  }
}

void CompactSolver::AddGear(double dt, TreeDynamics* dynamics, SolverJoint* joint) {
  const double bound = *joint->gear_force * dt;
  if (bound == 0.0) {
    joint->gear_impulse = 0.0;
    return;
  }
  const int stride = dynamics->stride();
  const int follower = dynamics->Coordinate(joint->link);
  const int leader = dynamics->Coordinate(joint->leader);
  double* jacobian = Take(stride);
  double* response = Take(stride);
  std::fill_n(jacobian, stride, 0.0);
  jacobian[follower] = 1.0;
  jacobian[leader] -= joint->multiplier;
  for (int i = 0; i < stride; ++i) {
    response[i] = dynamics->InverseInertia(follower)[i] -
                  joint->multiplier * dynamics->InverseInertia(leader)[i];
  }
  ConstraintRow row;
  row.a = {jacobian, dynamics->velocity(), response, dynamics->velocity(), stride, stride};
  const double mobility = Product(jacobian, response, stride);
  row.inertia = mobility > std::numeric_limits<double>::epsilon() ? 1.0 / mobility : 0.0;
  const double error = joint->offset + joint->multiplier * dynamics->JointPosition(joint->leader) -
                       dynamics->JointPosition(joint->link);
  row.target = error * kRecovery / dt;
  row.lower = -bound;
  row.upper = bound;
  row.impulse = kWarmShare * joint->gear_impulse;
  gears_.push_back(row);
  gear_kept_.push_back(&joint->gear_impulse);
}

void CompactSolver::ForgetImpulses(int tree) {
  for (SolverJoint& joint : trees_[static_cast<size_t>(tree)].joints) {
    joint.motor_impulse = joint.limit_impulses[0] = joint.limit_impulses[1] = 0.0;
    joint.gear_impulse = 0.0;
  }
}

void CompactSolver::WarmStart() {
  for (const JointRow& row : joints_) {
    const double impulse = row.sign * row.impulse;
    AddScaled(impulse, row.response, row.count, row.changed);
  }
  for (const auto* rows : {&gears_, &normals_}) {
    for (const ConstraintRow& row : *rows) {
      Apply(row.a, row.impulse);
      Apply(row.b, row.impulse);
    }
  }
}

// Runs with the processor's widest vectors. Both versions do the same operations in the same order
// (none contracts products and sums), so that results do not depend on the processor.
SIMWRIGHT_WIDEST_VECTORS void CompactSolver::Iterate(int iterations) {
  const auto solve_joint = [](JointRow * row) __attribute__((always_inline)) {
    const double impulse =
        Bounded(row->impulse + (row->target - row->sign * *row->velocity) * row->inertia -
                    row->impulse * row->compliance,
                row->lower, row->upper);
    const double change = row->sign * (impulse - row->impulse);
    row->impulse = impulse;
    AddScaled(change, row->response, row->count, row->changed);
  };
  for (int iteration = 0; iteration < iterations; ++iteration) {
    if (iteration % 2 == 1) {
      for (JointRow& row : joints_) solve_joint(&row);
      for (ConstraintRow& row : gears_) Solve(&row);
    } else {
      for (size_t i = gears_.size(); i > 0; --i) Solve(&gears_[i - 1]);
      for (size_t i = joints_.size(); i > 0; --i) solve_joint(&joints_[i - 1]);
    }
    for (ConstraintRow& row : normals_) Solve(&row);
    for (ConstraintRow& row : spins_) {
      const double pressed = normals_[static_cast<size_t>(row.normal)].impulse;
      if (pressed <= 0.0) continue;
      row.upper = row.friction * pressed;
      row.lower = -row.upper;
      Solve(&row);
    }
    SolveCones(normals_, true, &rollings_);
    SolveCones(normals_, false, &frictions_);
  }
}

void CompactSolver::Step(double dt, int iterations, const Eigen::Vector3d& gravity,
                         btDispatcher* dispatcher) {
  joints_.clear();
  for (auto* rows : {&gears_, &normals_, &frictions_, &rollings_, &spins_}) rows->clear();
  warm_.clear();
  gear_kept_.clear();
  for (const Tree& tree : trees_) {
    if (tree.asleep) continue;
    tree.dynamics->UpdatePoses();
    tree.dynamics->UpdateInverseInertia();
    tree.dynamics->StepFreely(gravity, dt);
  }
  Reserve(dispatcher);
  for (Tree& tree : trees_) {
    if (tree.asleep) continue;
    for (SolverJoint& joint : tree.joints) {
      AddMotor(dt, tree.dynamics, &joint);
      if (joint.leader >= 0) AddGear(dt, tree.dynamics, &joint);
      if (joint.limited) AddLimits(dt, tree.dynamics, &joint);
    }
  }
  for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
    AddContacts(dispatcher->getManifoldByIndexInternal(i), dt);
  }
  WarmStart();
  Iterate(iterations);
  KeepImpulses();
  for (const Tree& tree : trees_) {
    if (!tree.asleep) tree.dynamics->Integrate(dt);
  }
}

}  // namespace simwright::sim
