#include "scene/feasibility/narrow_phase.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"

namespace simwright::scene {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

geometry::ConvexShape Transformed(const geometry::ConvexShape& shape, const Isometry3d& pose) {
  geometry::ConvexShape transformed;
  transformed.radius = shape.radius;
  transformed.vertices.reserve(shape.vertices.size());
  for (const Vector3d& vertex : shape.vertices) transformed.vertices.push_back(pose * vertex);
  return transformed;
}

AlignedBox3d PartBox(const geometry::ConvexShape& shape) {
  AlignedBox3d box;
  for (const Vector3d& vertex : shape.vertices) box.extend(vertex);
  box.min().array() -= shape.radius;
  box.max().array() += shape.radius;
  return box;
}

}  // namespace

void ConvexBodies::Add(const std::vector<geometry::ConvexShape>& parts,
                       const Isometry3d& world_from_body, bool fixed) {
  const std::string place = "body " + std::to_string(bodies_.size());
  if (parts.empty()) throw core::Error("a body needs convex parts", place);
  if (!world_from_body.matrix().allFinite()) throw core::Error("its pose is not finite", place);
  Body body;
  body.fixed = fixed;
  for (const geometry::ConvexShape& shape : parts) {
    Part part;
    part.shape = Transformed(shape, world_from_body);
    part.box = PartBox(part.shape);
    const bool finite = part.box.min().allFinite() && part.box.max().allFinite();
    if (shape.vertices.empty() || !finite) {
      throw core::Error("a convex part needs finite vertices", place);
    }
    body.hull.box.extend(part.box);
    body.hull.shape.radius = std::max(body.hull.shape.radius, shape.radius);
    const auto& vertices = part.shape.vertices;
    body.hull.shape.vertices.insert(body.hull.shape.vertices.end(), vertices.begin(),
                                    vertices.end());
    body.parts.push_back(std::move(part));
  }
  bodies_.push_back(std::move(body));
}

std::vector<std::pair<int, int>> ConvexBodies::BroadPhasePairs(const std::vector<Vector3d>& shifts,
                                                               double within) const {
  std::vector<int> order(bodies_.size());
  std::iota(order.begin(), order.end(), 0);
  const auto left = [&](int i) {
    const auto k = static_cast<size_t>(i);
    return bodies_[k].hull.box.min().x() + shifts[k].x();
  };
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    const double a = left(i), b = left(j);
    return a != b ? a < b : i < j;
  });
  std::vector<std::pair<int, int>> pairs;
  for (size_t i = 0; i < order.size(); ++i) {
    const auto a = static_cast<size_t>(order[i]);
    const double right = bodies_[a].hull.box.max().x() + shifts[a].x() + within;
    for (size_t j = i + 1; j < order.size() && left(order[j]) < right; ++j) {
      const auto b = static_cast<size_t>(order[j]);
      if (bodies_[a].fixed && bodies_[b].fixed) continue;
      if (Gap(bodies_[a].hull.box, bodies_[b].hull.box, shifts[b] - shifts[a]) >= within) continue;
      pairs.emplace_back(std::min(order[i], order[j]), std::max(order[i], order[j]));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

NarrowPhasePair ConvexBodies::Distance(int a, int part_a, int b, int part_b,
                                       const Vector3d& apart) const {
  Isometry3d at_b = Isometry3d::Identity();
  at_b.translation() = apart;
  const geometry::ConvexDistance found = geometry::SignedDistance(
      PartOf(a, part_a).shape, Isometry3d::Identity(), PartOf(b, part_b).shape, at_b);
  return {a, b, part_a, part_b, found.distance, found.normal};
}

double ConvexBodies::DepthAlong(int a, int b, const Vector3d& apart, const Vector3d& normal) const {
  const geometry::ConvexShape& one = PartOf(a, -1).shape;
  const geometry::ConvexShape& other = PartOf(b, -1).shape;
  double farthest = -HUGE_VAL, nearest = HUGE_VAL;
  for (const Vector3d& vertex : one.vertices) farthest = std::max(farthest, normal.dot(vertex));
  for (const Vector3d& vertex : other.vertices) nearest = std::min(nearest, normal.dot(vertex));
  return farthest + one.radius - (nearest + normal.dot(apart) - other.radius);
}

void ConvexBodies::Find(const std::vector<Vector3d>& shifts, double within,
                        std::vector<NarrowPhasePair>* near) const {
  near->clear();
  for (const auto& [a, b] : BroadPhasePairs(shifts, within)) {
    const Vector3d apart = shifts[static_cast<size_t>(b)] - shifts[static_cast<size_t>(a)];
    ForEachClosePart(a, b, apart, within, false, [&, a = a, b = b](int part_a, int part_b) {
      const NarrowPhasePair found = Distance(a, part_a, b, part_b, apart);
      if (found.distance < within) near->push_back(found);
    });
  }
}

}  // namespace simwright::scene
