// The contact constraints of CompactSolver.
#include <algorithm>
#include <cmath>
#include <limits>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "sim/bullet_shape.h"
#include "sim/compact_solver.h"

namespace simwright::sim {
namespace {

// The settings of btContactSolverInfo:
constexpr double kContactRecovery = 0.2;    // the share of a penetration that one step corrects
constexpr double kBounceSpeed = 0.2;        // m/s: slower contacts have no restitution
constexpr double kContactWarmShare = 0.85;  // of the last step's impulse
constexpr double kLargestImpulse = 1e10;    // N s
constexpr double kLeastPull = 1e-5;         // N s
constexpr int kRowsPerContact = 6;          // normal, 2 friction, spin, 2 rolling

}  // namespace

double* CompactSolver::Take(int count) {
  double* taken = &numbers_[taken_];
  taken_ += static_cast<size_t>(count);
  return taken;
}

// Rows hold pointers into numbers_, so that it must not grow while they are made.
void CompactSolver::Reserve(btDispatcher* dispatcher) {
  size_t widest = 0, gears = 0, points = 0;
  for (const Tree& tree : trees_) {
    widest = std::max(widest, static_cast<size_t>(tree.dynamics->stride()));
    for (const SolverJoint& joint : tree.joints) gears += joint.leader >= 0 ? 1 : 0;
  }
  for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
    points += static_cast<size_t>(dispatcher->getManifoldByIndexInternal(i)->getNumContacts());
  }
  const size_t needed = 2 * widest * (gears + 2 * kRowsPerContact * points) + 1;
  if (numbers_.size() < needed) numbers_.resize(2 * needed);
  taken_ = 0;
}

CompactSolver::Touch CompactSolver::TouchOf(const btPersistentManifold& manifold,
                                            bool first) const {
  Touch touch;
  touch.sign = first ? 1.0 : -1.0;
  const btCollisionObject* object = first ? manifold.getBody0() : manifold.getBody1();
  const int tree = object->getUserIndex();
  const auto* collider = btMultiBodyLinkCollider::upcast(object);
  if (collider == nullptr || tree < 0) return touch;
  TreeDynamics* dynamics = trees_[static_cast<size_t>(tree)].dynamics;
  touch.link = collider->m_link;
  if (!IsAsleep(tree) && dynamics->Moves(touch.link)) touch.dynamics = dynamics;
  return touch;
}

RowSide CompactSolver::MakeSide(const Touch& touch, const Eigen::Vector3d& direction, Kind kind) {
  RowSide side;
  if (touch.dynamics == nullptr) return side;
  const Eigen::Vector3d signed_direction = touch.sign * direction;
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const int stride = touch.dynamics->stride();
  double* jacobian = Take(stride);
  double* response = Take(stride);
  const Span read =
      kind == Kind::kForce
          ? touch.dynamics->Jacobian(touch.link, touch.point, signed_direction, none, jacobian)
          : touch.dynamics->Jacobian(touch.link, touch.point, none, signed_direction, jacobian);
  const Span written = touch.dynamics->Respond(touch.link, jacobian, read, response);
  side.jacobian = jacobian + read.first;
  side.velocity = touch.dynamics->velocity() + read.first;
  side.jacobian_count = read.count;
  side.response = response + written.first;
  side.changed = touch.dynamics->velocity() + written.first;
  side.response_count = written.count;
  return side;
}

ConstraintRow CompactSolver::MakeRow(const Contact& contact, const Eigen::Vector3d& direction,
                                     Kind kind) {
  ConstraintRow row;
  row.a = MakeSide(contact.a, direction, kind);
  row.b = MakeSide(contact.b, direction, kind);
  double mobility = 0.0;
  for (const RowSide* side : {&row.a, &row.b}) {
    const auto offset = side->velocity - side->changed;  // the Jacobian's first, in the response
    mobility += Product(side->jacobian, side->response + offset, side->jacobian_count);
  }
  row.inertia = mobility > std::numeric_limits<double>::epsilon() ? 1.0 / mobility : 0.0;
  row.normal = static_cast<int>(normals_.size()) - 1;
  return row;
}

void CompactSolver::AddNormal(const Contact& contact, double dt) {
  btManifoldPoint& point = *contact.point;
  ConstraintRow row = MakeRow(contact, FromBullet(point.m_normalWorldOnB), Kind::kForce);
  const double speed = Speed(row.a) + Speed(row.b);  // before the contact
  const double distance = point.getDistance();
  if (std::abs(speed) >= kBounceSpeed) {
    row.target = std::max(0.0, -point.m_combinedRestitution * speed);
  }
  row.target -= (distance > 0.0 ? distance : distance * kContactRecovery) / dt;
  row.upper = kLargestImpulse;
  const double pull = (row.target - speed) * row.inertia, last = point.m_prevRHS;
  if (std::abs(last) > kLeastPull && last < 2.0 * pull && pull < 2.0 * last) {
    row.impulse = std::max(0.0, kContactWarmShare * point.m_appliedImpulse / last * pull);
  }
  normals_.push_back(row);
  warm_.push_back({contact.point, pull});
}

void CompactSolver::AddFriction(const Contact& contact) {
  btVector3 one, two;
  btPlaneSpace1(contact.point->m_normalWorldOnB, one, two);
  const Eigen::Vector3d directions[2] = {FromBullet(one), FromBullet(two)};
  for (const Eigen::Vector3d& direction : directions) {
    frictions_.push_back(MakeRow(contact, direction, Kind::kForce));
    frictions_.back().friction = contact.point->m_combinedFriction;
  }
  AddTurningFriction(contact, directions);
}

void CompactSolver::AddTurningFriction(const Contact& contact,
                                       const Eigen::Vector3d (&directions)[2]) {
  const btManifoldPoint& point = *contact.point;
  if (point.m_combinedSpinningFriction > 0.0) {
    spins_.push_back(MakeRow(contact, FromBullet(point.m_normalWorldOnB), Kind::kTorque));
    spins_.back().friction = point.m_combinedSpinningFriction;
  }
  if (!(point.m_combinedRollingFriction > 0.0)) return;
  for (const Eigen::Vector3d& direction : directions) {
    rollings_.push_back(MakeRow(contact, direction, Kind::kTorque));
    rollings_.back().friction = point.m_combinedRollingFriction;
  }
}

void CompactSolver::AddContacts(btPersistentManifold* manifold, double dt) {
  if (manifold->getNumContacts() == 0) return;
  Contact contact{TouchOf(*manifold, true), TouchOf(*manifold, false)};
  if (contact.a.dynamics == nullptr && contact.b.dynamics == nullptr) return;
  for (int i = 0; i < manifold->getNumContacts(); ++i) {
    contact.point = &manifold->getContactPoint(i);
    contact.a.point = FromBullet(contact.point->getPositionWorldOnA());
    contact.b.point = FromBullet(contact.point->getPositionWorldOnB());
    AddNormal(contact, dt);
    AddFriction(contact);
  }
}

void CompactSolver::KeepImpulses() {
  for (const JointRow& row : joints_) *row.kept = row.impulse;
  for (size_t i = 0; i < gears_.size(); ++i) *gear_kept_[i] = gears_[i].impulse;
  for (size_t i = 0; i < warm_.size(); ++i) {
    warm_[i].point->m_appliedImpulse = normals_[i].impulse;
    warm_[i].point->m_prevRHS = warm_[i].pull;
  }
}

}  // namespace simwright::sim
