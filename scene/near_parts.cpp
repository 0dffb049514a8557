#include "scene/near_parts.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"

namespace simwright::scene {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

geometry::ConvexShape Turned(const geometry::ConvexShape& shape, const Isometry3d& pose) {
  geometry::ConvexShape turned;
  turned.radius = shape.radius;
  turned.vertices.reserve(shape.vertices.size());
  for (const Vector3d& vertex : shape.vertices) turned.vertices.push_back(pose * vertex);
  return turned;
}

AlignedBox3d BoxOf(const geometry::ConvexShape& shape) {
  AlignedBox3d box;
  for (const Vector3d& vertex : shape.vertices) box.extend(vertex);
  box.min().array() -= shape.radius;
  box.max().array() += shape.radius;
  return box;
}

// m between two boxes along the axis on which they are farthest apart, less than 0 where they
// overlap: no more than their distance.
double Gap(const AlignedBox3d& a, const Vector3d& shift_a, const AlignedBox3d& b,
           const Vector3d& shift_b) {
  const Vector3d one = (b.min() + shift_b) - (a.max() + shift_a);
  const Vector3d other = (a.min() + shift_a) - (b.max() + shift_b);
  return one.cwiseMax(other).maxCoeff();
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
    part.shape = Turned(shape, world_from_body);
    part.box = BoxOf(part.shape);
    const bool finite = part.box.min().allFinite() && part.box.max().allFinite();
    if (shape.vertices.empty() || !finite) {
      throw core::Error("a convex part needs vertices that are finite", place);
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

std::vector<std::pair<int, int>> ConvexBodies::NearBodies(const std::vector<Vector3d>& shifts,
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
      if (Gap(bodies_[a].hull.box, shifts[a], bodies_[b].hull.box, shifts[b]) >= within) continue;
      pairs.emplace_back(std::min(order[i], order[j]), std::max(order[i], order[j]));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void ConvexBodies::FindBetween(int a, int b, const std::vector<Vector3d>& shifts, double within,
                               bool by_hull, std::vector<NearParts>* near) const {
  const auto i = static_cast<size_t>(a), j = static_cast<size_t>(b);
  Isometry3d from_a = Isometry3d::Identity(), from_b = Isometry3d::Identity();
  from_a.translation() = shifts[i];
  from_b.translation() = shifts[j];
  const auto look = [&](const Part& part_a, const Part& part_b, int index_a, int index_b) {
    if (Gap(part_a.box, shifts[i], part_b.box, shifts[j]) >= within) return;
    const geometry::ConvexDistance found =
        geometry::SignedDistance(part_a.shape, from_a, part_b.shape, from_b);
    if (found.distance >= within) return;
    near->push_back({a, b, index_a, index_b, found.distance, found.normal});
  };
  if (by_hull) {
    look(bodies_[i].hull, bodies_[j].hull, -1, -1);
    return;
  }
  for (size_t p = 0; p < bodies_[i].parts.size(); ++p) {
    const Part& part = bodies_[i].parts[p];
    if (Gap(part.box, shifts[i], bodies_[j].hull.box, shifts[j]) >= within) continue;
    for (size_t q = 0; q < bodies_[j].parts.size(); ++q) {
      look(part, bodies_[j].parts[q], static_cast<int>(p), static_cast<int>(q));
    }
  }
}

}  // namespace simwright::scene
