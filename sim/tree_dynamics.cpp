#include "sim/tree_dynamics.h"

#include <algorithm>
#include <cmath>

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include "sim/bullet_shape.h"
#include "sim/lanes.h"

namespace simwright::sim {
namespace {

constexpr int kRoot = 6;                   // coordinates of a free root
constexpr double kSamePosition = 1e-12;    // rad or m
constexpr double kStillPosition = 1e-5;    // rad or m
constexpr double kFastest = 100.0;         // rad/s or m/s, Bullet's bound on each velocity
constexpr double kLargestTurn = M_PI / 4;  // rad per step, Bullet's bound

int Padded(int count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

Eigen::Matrix3d Matrix(const btQuaternion& q) {
  return Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).toRotationMatrix();
}

Eigen::Matrix3d Cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d cross;
  cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return cross;
}

}  // namespace

TreeDynamics::TreeDynamics(btMultiBody* body)
    : body_(*body),
      free_(!body->hasFixedBase()),
      size_((free_ ? kRoot : 0) + body->getNumDofs()),
      stride_(Padded(size_)) {
  links_.resize(static_cast<size_t>(body->getNumLinks()) + 1);
  above_.assign(static_cast<size_t>(size_), -1);
  for (int i = 1; free_ && i < kRoot; ++i) above_[static_cast<size_t>(i)] = i - 1;
  links_[0].mass = body->getBaseMass();
  links_[0].moments = FromBullet(body->getBaseInertia());
  links_[0].last = free_ ? kRoot - 1 : -1;
  for (int i = 0; i < body->getNumLinks(); ++i) AddLink(i);
  SetReaches();
  still_joints_.assign(links_.size(), 0.0);
  composite_.resize(links_.size());
  velocities_.resize(links_.size());
  accelerations_.resize(links_.size());
  forces_.resize(links_.size());
  for (auto* matrix : {&factor_, &factor_inverse_, &inverse_}) matrix->assign(Offset(size_), 0.0);
  velocity_.assign(static_cast<size_t>(stride_), 0.0);
  load_.assign(static_cast<size_t>(stride_), 0.0);
}

void TreeDynamics::AddLink(int index) {
  const btMultibodyLink& from = body_.getLink(index);
  Link& link = links_[static_cast<size_t>(index) + 1];
  link.parent = from.m_parent + 1;
  const Link& parent = links_[static_cast<size_t>(link.parent)];
  link.last = parent.last;
  if (from.m_dofCount > 0) {
    link.coordinate = (free_ ? kRoot : 0) + from.m_dofOffset;
    above_[static_cast<size_t>(link.coordinate)] = parent.last;
    link.last = link.coordinate;
  }
  link.revolute = from.m_jointType == btMultibodyLink::eRevolute;
  if (from.m_dofCount > 0) {
    link.axis = FromBullet(link.revolute ? from.getAxisTop(0) : from.getAxisBottom(0));
  }
  link.to_pivot = FromBullet(from.m_eVector);
  link.to_center = FromBullet(from.m_dVector);
  const Eigen::Matrix3d zero = Matrix(from.m_zeroRotParentToThis).transpose();
  const Eigen::Matrix3d along = link.axis * link.axis.transpose();
  link.still = link.revolute ? Eigen::Matrix3d(zero * along) : zero;
  link.cosine = zero * (Eigen::Matrix3d::Identity() - along);  // Rodrigues' formula
  link.sine = zero * Cross(link.axis);
  link.mass = from.m_mass;
  link.moments = FromBullet(from.m_inertiaLocal);
}

// An impulse moves all links that are joined other than through a fixed root.
void TreeDynamics::SetReaches() {
  std::vector<int> branch(links_.size(), 0), first, last;
  for (size_t i = 1; i < links_.size(); ++i) {
    const auto parent = static_cast<size_t>(links_[i].parent);
    branch[i] = !free_ && parent == 0 ? static_cast<int>(i) : branch[parent];
  }
  first.assign(links_.size(), size_);
  last.assign(links_.size(), -1);
  if (free_) {
    first[0] = 0;
    last[0] = kRoot - 1;
  }
  for (size_t i = 1; i < links_.size(); ++i) {
    const int coordinate = links_[i].coordinate;
    const auto b = static_cast<size_t>(branch[i]);
    if (coordinate < 0) continue;
    first[b] = std::min(first[b], coordinate);
    last[b] = std::max(last[b], coordinate);
  }
  for (size_t i = 0; i < links_.size(); ++i) {
    const auto b = static_cast<size_t>(branch[i]);
    if (last[b] < 0) continue;
    links_[i].reach.first = first[b] / kLanes * kLanes;
    links_[i].reach.count = Padded(last[b] + 1) - links_[i].reach.first;
  }
}

double TreeDynamics::JointPosition(int link) const {
  return body_.getLink(link).m_jointPos[0];
}

// Positions that are not finite count as moved, so that they reach the poses.
bool TreeDynamics::HasMoved() const {
  const btQuaternion& q = body_.getWorldToBaseRot();
  const Eigen::Vector4d turn(q.x(), q.y(), q.z(), q.w());
  const double moved = (FromBullet(body_.getBasePos()) - root_position_).norm();
  if (!(moved <= kSamePosition) || !((turn - root_turn_).norm() <= kSamePosition)) return true;
  for (size_t i = 1; i < links_.size(); ++i) {
    if (links_[i].coordinate < 0) continue;
    const double position = JointPosition(static_cast<int>(i) - 1);
    if (!(std::abs(position - links_[i].position) <= kSamePosition)) return true;
  }
  return false;
}

void TreeDynamics::PoseLink(Link* link) const {
  const Link& parent = links_[static_cast<size_t>(link->parent)];
  const Eigen::Vector3d pivot = parent.center + parent.rotation * link->to_pivot;
  if (link->revolute) {
    link->rotation = parent.rotation * (link->still + std::cos(link->position) * link->cosine +
                                        std::sin(link->position) * link->sine);
    link->center = pivot + link->rotation * link->to_center;
    link->motion.angular = link->rotation * link->axis;
    link->motion.linear = (pivot - root_position_).cross(link->motion.angular);
    return;
  }
  link->rotation = parent.rotation * link->still;
  link->motion.linear = link->rotation * link->axis;
  link->center = pivot + link->rotation * link->to_center + link->position * link->motion.linear;
}

bool TreeDynamics::UpdatePoses() {
  if (posed_ && !HasMoved()) return false;
  posed_ = true;
  inverted_ = false;
  const btQuaternion& q = body_.getWorldToBaseRot();
  root_position_ = FromBullet(body_.getBasePos());
  root_turn_ = Eigen::Vector4d(q.x(), q.y(), q.z(), q.w());
  links_[0].rotation = Matrix(q).transpose();
  links_[0].center = root_position_;
  for (size_t i = 1; i < links_.size(); ++i) {
    if (links_[i].coordinate >= 0) {
      links_[i].position = body_.getLink(static_cast<int>(i) - 1).m_jointPos[0];
    }
    PoseLink(&links_[i]);
  }
  return true;
}

Span TreeDynamics::Jacobian(int link, const Eigen::Vector3d& point, const Eigen::Vector3d& force,
                            const Eigen::Vector3d& torque, double* row) const {
  const Link* at = &links_[static_cast<size_t>(link + 1)];
  if (at->last < 0) return {at->reach.first, 0};
  const Span span{at->reach.first, Padded(at->last + 1) - at->reach.first};
  std::fill_n(row + span.first, span.count, 0.0);
  const Eigen::Vector3d moment = torque + (point - root_position_).cross(force);
  for (; at->parent >= 0; at = &links_[static_cast<size_t>(at->parent)]) {
    if (at->coordinate < 0) continue;
    row[at->coordinate] = at->motion.angular.dot(moment) + at->motion.linear.dot(force);
  }
  if (free_) {
    Vector(row) = moment;
    Vector(row + 3) = force;
  }
  return span;
}

Span TreeDynamics::Respond(int link, const double* row, Span nonzero, double* response) const {
  const Span reach = Reach(link);
  std::fill_n(response + reach.first, reach.count, 0.0);
  const int end = std::min(nonzero.first + nonzero.count, size_);
  for (int j = nonzero.first; j < end; ++j) {
    const double share = row[j];
    if (share == 0.0) continue;
    AddScaled(share, InverseInertia(j) + reach.first, reach.count, response + reach.first);
  }
  return reach;
}

TreeDynamics::Spatial TreeDynamics::Momentum(const SpatialInertia& inertia, const Spatial& motion) {
  return {inertia.rotational * motion.angular + inertia.moment.cross(motion.linear),
          inertia.mass * motion.linear + motion.angular.cross(inertia.moment)};
}

// Recursive Newton-Euler, Featherstone, Rigid Body Dynamics Algorithms (2008), table 5.1, with all
// quantities in the world frame: writes the forces (n) that would hold the accelerations at zero.
void TreeDynamics::Bias(const Eigen::Vector3d& gravity, double* forces) {
  if (free_) {
    velocities_[0].angular = Vector(velocity_.data());
    velocities_[0].linear = Vector(velocity_.data() + 3);
  }
  accelerations_[0].linear = -gravity;
  forces_[0] = Spatial();
  for (size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    Spatial& v = velocities_[i];
    Spatial& a = accelerations_[i];
    if (i > 0) {
      v = velocities_[static_cast<size_t>(link.parent)];
      a = accelerations_[static_cast<size_t>(link.parent)];
    }
    if (link.coordinate >= 0) {
      const double speed = velocity_[static_cast<size_t>(link.coordinate)];
      const Spatial joint{speed * link.motion.angular, speed * link.motion.linear};
      v.angular += joint.angular;
      v.linear += joint.linear;
      a.linear += v.angular.cross(joint.linear) + v.linear.cross(joint.angular);
      a.angular += v.angular.cross(joint.angular);
    }
    if (i == 0 && !free_) continue;
    const Spatial momentum = Momentum(link.inertia, v);
    forces_[i] = Momentum(link.inertia, a);
    forces_[i].angular += v.angular.cross(momentum.angular) + v.linear.cross(momentum.linear);
    forces_[i].linear += v.angular.cross(momentum.linear);
  }
  for (size_t i = links_.size() - 1; i > 0; --i) {
    const Link& link = links_[i];
    if (link.coordinate >= 0) forces[link.coordinate] = link.motion.Dot(forces_[i]);
    Spatial& parent = forces_[static_cast<size_t>(link.parent)];
    parent.angular += forces_[i].angular;
    parent.linear += forces_[i].linear;
  }
  if (!free_) return;
  Vector(forces) = forces_[0].angular;
  Vector(forces + 3) = forces_[0].linear;
}

void TreeDynamics::StepFreely(const Eigen::Vector3d& gravity, double dt) {
  std::copy_n(body_.getVelocityVector() + (free_ ? 0 : kRoot), size_, velocity_.begin());
  Bias(gravity, load_.data());
  for (double& load : load_) load = -load;
  if (free_) {
    Vector(load_.data()) += FromBullet(body_.getBaseTorque());
    Vector(load_.data() + 3) += FromBullet(body_.getBaseForce());
  }
  for (size_t i = 1; i < links_.size(); ++i) {
    if (links_[i].coordinate < 0) continue;
    load_[static_cast<size_t>(links_[i].coordinate)] +=
        body_.getJointTorque(static_cast<int>(i) - 1);
  }
  // The acceleration of a free root's centre is its spatial acceleration and w x v.
  if (free_) {
    const Eigen::Vector3d w = Vector(velocity_.data()), v = Vector(velocity_.data() + 3);
    Vector(velocity_.data() + 3) += dt * w.cross(v);
  }
  for (int j = 0; j < size_; ++j) {
    const double share = dt * load_[static_cast<size_t>(j)];
    AddScaled(share, InverseInertia(j), stride_, velocity_.data());
  }
  for (double& velocity : velocity_) velocity = std::clamp(velocity, -kFastest, kFastest);
}

// Turns the root by the exponential map, like btMultiBody::stepPositionsMultiDof.
void TreeDynamics::IntegrateRoot(double dt) {
  const Eigen::Vector3d w = Vector(velocity_.data());
  const Eigen::Vector3d v = Vector(velocity_.data() + 3);
  body_.setBasePos(body_.getBasePos() + ToBullet(Eigen::Vector3d(dt * v)));
  double speed = w.norm();
  if (speed * dt > kLargestTurn) speed = kLargestTurn / dt;
  const double half = 0.5 * speed * dt;
  const Eigen::Vector3d turn =
      w * (speed < 1e-3 ? 0.5 * dt - dt * dt * dt * speed * speed / 48.0 : std::sin(half) / speed);
  btQuaternion q =
      body_.getWorldToBaseRot() * btQuaternion(-turn.x(), -turn.y(), -turn.z(), std::cos(half));
  body_.setWorldToBaseRot(q.normalize());
}

void TreeDynamics::Integrate(double dt) {
  for (double& velocity : velocity_) velocity = std::clamp(velocity, -kFastest, kFastest);
  if (free_) {
    const double* v = velocity_.data();
    body_.setBaseOmega(btVector3(v[0], v[1], v[2]));
    body_.setBaseVel(btVector3(v[3], v[4], v[5]));
    IntegrateRoot(dt);
  }
  for (size_t i = 1; i < links_.size(); ++i) {
    if (links_[i].coordinate < 0) continue;
    const double speed = velocity_[static_cast<size_t>(links_[i].coordinate)];
    body_.setJointVel(static_cast<int>(i) - 1, speed);
    body_.getLink(static_cast<int>(i) - 1).m_jointPos[0] += dt * speed;
  }
  body_.clearForcesAndTorques();
  CountStillSteps();
}

void TreeDynamics::CountStillSteps() {
  const btQuaternion& q = body_.getWorldToBaseRot();
  const Eigen::Vector3d position = FromBullet(body_.getBasePos());
  const Eigen::Vector4d turn(q.x(), q.y(), q.z(), q.w());
  bool still = (position - still_position_).norm() < kStillPosition &&
               (turn - still_turn_).norm() < 0.5 * kStillPosition;
  for (size_t i = 1; i < links_.size() && still; ++i) {
    still = links_[i].coordinate < 0 ||
            std::abs(JointPosition(static_cast<int>(i) - 1) - still_joints_[i]) < kStillPosition;
  }
  ++still_steps_;
  if (still) return;
  still_steps_ = 0;
  still_position_ = position;
  still_turn_ = turn;
  for (size_t i = 1; i < links_.size(); ++i) {
    if (links_[i].coordinate >= 0) still_joints_[i] = JointPosition(static_cast<int>(i) - 1);
  }
}

void TreeDynamics::Stop() {
  std::fill(velocity_.begin(), velocity_.end(), 0.0);
  body_.clearVelocities();
}

}  // namespace simwright::sim
