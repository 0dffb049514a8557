// The inertia matrix of TreeDynamics and its inverse.
#include <cmath>

#include "sim/tree_dynamics.h"

namespace simwright::sim {
namespace {

constexpr int kRootCoordinates = 6;

}  // namespace

void TreeDynamics::SetInertia(Link* link) const {
  const Eigen::Vector3d center = link->center - root_position_;
  link->inertia.mass = link->mass;
  link->inertia.moment = link->mass * center;
  const Eigen::Matrix3d scaled = link->rotation * link->moments.asDiagonal();
  link->inertia.rotational = scaled * link->rotation.transpose();
  link->inertia.rotational.diagonal().array() += link->mass * center.squaredNorm();
  link->inertia.rotational -= link->inertia.moment * center.transpose();  // parallel axis theorem
}

// The composite-rigid-body algorithm, Featherstone (2008), table 6.2, in the world frame, where the
// inertias of a link's children are added without transforms. Fills the lower triangle.
void TreeDynamics::FillInertiaMatrix() {
  for (size_t i = 0; i < links_.size(); ++i) {
    SetInertia(&links_[i]);
    composite_[i] = links_[i].inertia;
  }
  for (size_t i = links_.size() - 1; i > 0; --i) {
    const Link& link = links_[i];
    SpatialInertia& parent = composite_[static_cast<size_t>(link.parent)];
    parent.mass += composite_[i].mass;
    parent.moment += composite_[i].moment;
    parent.rotational += composite_[i].rotational;
    if (link.coordinate < 0) continue;
    const Spatial momentum = Momentum(composite_[i], link.motion);
    double* row = &factor_[Offset(link.coordinate)];
    row[link.coordinate] = link.motion.Dot(momentum);
    for (int a = link.parent; a > 0; a = links_[static_cast<size_t>(a)].parent) {
      const Link& carrier = links_[static_cast<size_t>(a)];
      if (carrier.coordinate >= 0) row[carrier.coordinate] = carrier.motion.Dot(momentum);
    }
    if (!free_) continue;
    Vector(row) = momentum.angular;
    Vector(row + 3) = momentum.linear;
  }
  if (!free_) return;
  for (int i = 0; i < kRootCoordinates; ++i) {
    Spatial unit;
    (i < 3 ? unit.angular[i] : unit.linear[i - 3]) = 1.0;
    const Spatial momentum = Momentum(composite_[0], unit);
    double* row = &factor_[Offset(i)];
    for (int j = 0; j <= i; ++j) row[j] = j < 3 ? momentum.angular[j] : momentum.linear[j - 3];
  }
}

// Replaces the inertia matrix M by the factor L of M = L^T L, which has zeros wherever M has
// (Featherstone 2008, table 6.3).
void TreeDynamics::Factorize() {
  for (int k = size_ - 1; k >= 0; --k) {
    double* row = &factor_[Offset(k)];
    row[k] = row[k] > 0.0 ? std::sqrt(row[k]) : 0.0;
    const double scale = row[k] > 0.0 ? 1.0 / row[k] : 0.0;
    for (int i = above_[static_cast<size_t>(k)]; i >= 0; i = above_[static_cast<size_t>(i)]) {
      row[i] *= scale;
    }
    for (int i = above_[static_cast<size_t>(k)]; i >= 0; i = above_[static_cast<size_t>(i)]) {
      double* changed = &factor_[Offset(i)];
      for (int j = i; j >= 0; j = above_[static_cast<size_t>(j)]) changed[j] -= row[i] * row[j];
    }
  }
}

// Computes L^-1 and from it M^-1 = L^-1 L^-T.
void TreeDynamics::Invert() {
  for (int k = 0; k < size_; ++k) {
    const double* row = &factor_[Offset(k)];
    double* out = &factor_inverse_[Offset(k)];
    out[k] = row[k] > 0.0 ? 1.0 / row[k] : 0.0;
    for (int i = above_[static_cast<size_t>(k)]; i >= 0; i = above_[static_cast<size_t>(i)]) {
      out[i] = 0.0;
    }
    for (int j = above_[static_cast<size_t>(k)]; j >= 0; j = above_[static_cast<size_t>(j)]) {
      const double share = out[k] * row[j];
      const double* carrier = &factor_inverse_[Offset(j)];
      for (int i = j; i >= 0; i = above_[static_cast<size_t>(i)]) out[i] -= share * carrier[i];
    }
  }
  for (int i = 0; i < size_; ++i) {
    const double* row = &factor_inverse_[Offset(i)];
    for (int j = 0; j <= i; ++j) {
      const double* other = &factor_inverse_[Offset(j)];
      double sum = 0.0;
      for (int k = 0; k <= j; ++k) sum += row[k] * other[k];
      inverse_[Offset(i) + static_cast<size_t>(j)] = sum;
      inverse_[Offset(j) + static_cast<size_t>(i)] = sum;
    }
  }
}

void TreeDynamics::InvertFreeBody() {
  const Link& root = links_[0];
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (root.moments[i] > 0.0) inverse[i] = 1.0 / root.moments[i];
  }
  const Eigen::Matrix3d turned = root.rotation * inverse.asDiagonal() * root.rotation.transpose();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) inverse_[Offset(i) + static_cast<size_t>(j)] = turned(i, j);
    const auto linear = static_cast<size_t>(i + 3);
    inverse_[Offset(i + 3) + linear] = root.mass > 0.0 ? 1.0 / root.mass : 0.0;
  }
}

void TreeDynamics::UpdateInverseInertia() {
  if (inverted_) return;
  inverted_ = true;
  if (free_ && links_.size() == 1) {
    SetInertia(&links_[0]);
    InvertFreeBody();
    return;
  }
  FillInertiaMatrix();
  Factorize();
  Invert();
}

}  // namespace simwright::sim
