#include "scene/feasibility/contact_planes.h"

#include <algorithm>
#include <cmath>

namespace simwright::scene {

using Eigen::Vector3d;

void ContactPlanes::Update(const std::vector<Vector3d>& shifts) {
  std::vector<BodyPair> pairs;
  auto old = pairs_.begin();
  for (const auto& [a, b] : bodies_->BroadPhasePairs(shifts, options_.contact_margin)) {
    while (old != pairs_.end() && std::pair(old->a, old->b) < std::pair(a, b)) ++old;
    const bool known = old != pairs_.end() && old->a == a && old->b == b;
    pairs.push_back(known ? std::move(*old) : BodyPair{a, b, {}});
    UpdatePair(shifts, &pairs.back());
  }
  pairs_ = std::move(pairs);
}

void ContactPlanes::UpdatePair(const std::vector<Vector3d>& shifts, BodyPair* pair) {
  const bool by_hull = by_hull_.count({pair->a, pair->b}) > 0;
  const Vector3d apart =
      shifts[static_cast<size_t>(pair->b)] - shifts[static_cast<size_t>(pair->a)];
  std::vector<Plane> planes;
  planes.reserve(pair->planes.size());
  auto old = pair->planes.begin();
  const auto end = pair->planes.end();
  bodies_->ForEachClosePart(
      pair->a, pair->b, apart, options_.contact_margin, by_hull, [&](int part_a, int part_b) {
        const std::pair parts(part_a, part_b);
        while (old != end && std::pair(old->part_a, old->part_b) < parts) ++old;
        const bool known = old != end && old->part_a == part_a && old->part_b == part_b;
        Plane plane;
        if (known) {
          plane = *old;
          plane.bound = plane.normal.dot(apart) - plane.least;
          const bool inactive = plane.lambda == 0.0 && plane.bound >= -options_.tolerance;
          if (inactive || plane.taken_at == apart) return planes.push_back(plane);
        }
        const NarrowPhasePair taken = bodies_->Distance(pair->a, part_a, pair->b, part_b, apart);
        plane.part_a = part_a;
        plane.part_b = part_b;
        plane.normal = taken.normal;
        plane.taken_at = apart;
        plane.bound = taken.distance;
        plane.least = taken.normal.dot(apart) - taken.distance;
        planes.push_back(plane);
      });
  pair->planes = std::move(planes);
  if (!by_hull && Deepest(*pair) > options_.tolerance && IsHullSeparationShorter(*pair, shifts) &&
      UseConvexHull(pair->a, pair->b)) {
    pair->planes.clear();
    UpdatePair(shifts, pair);
  }
}

double ContactPlanes::Deepest(const BodyPair& pair) const {
  double deepest = 0.0;
  for (const Plane& plane : pair.planes) deepest = std::max(deepest, -plane.bound);
  return deepest;
}

bool ContactPlanes::IsHullSeparationShorter(const BodyPair& pair,
                                            const std::vector<Vector3d>& shifts) const {
  const Vector3d apart = shifts[static_cast<size_t>(pair.b)] - shifts[static_cast<size_t>(pair.a)];
  std::vector<SeparationConstraint> rows;
  for (const Plane& plane : pair.planes) {
    rows.push_back({0, 1, plane.normal, plane.least - plane.normal.dot(apart), 0.0});
  }
  const double by_hull = -bodies_->Distance(pair.a, -1, pair.b, -1, apart).distance;
  PgsOptions least;
  least.max_lambda = 10.0 * by_hull;
  std::vector<Vector3d> displacement;  // of b only
  const double missing = SolveLeastDisplacement({1, 0}, least, &rows, &displacement);
  return missing > options_.tolerance || displacement[1].norm() > by_hull;
}

void ContactPlanes::ReplacePlane(const Vector3d& normal, double depth, const Vector3d& apart,
                                 Plane* plane) {
  plane->normal = normal;
  plane->bound = -depth;
  plane->taken_at = apart;
  plane->least = normal.dot(apart) + depth;
  plane->lambda = 0.0;
}

bool ContactPlanes::SwitchToNormal(int a, int b, const Vector3d& normal,
                                   const std::vector<Vector3d>& shifts) {
  for (BodyPair& pair : pairs_) {
    if (pair.a != a || pair.b != b || pair.planes.size() != 1) continue;
    const Vector3d apart = shifts[static_cast<size_t>(b)] - shifts[static_cast<size_t>(a)];
    ReplacePlane(normal, bodies_->DepthAlong(a, b, apart, normal), apart, &pair.planes.front());
    return true;
  }
  return false;
}

void ContactPlanes::SwitchToLateralNormal(const std::vector<std::pair<int, int>>& pairs,
                                          const std::vector<Vector3d>& shifts) {
  constexpr int kDirections = 16;
  Plane* replaced = nullptr;
  Vector3d best, taken_at;
  double shallowest = HUGE_VAL;
  for (BodyPair& pair : pairs_) {
    const std::pair bodies(pair.a, pair.b);
    if (pair.planes.size() != 1 || std::find(pairs.begin(), pairs.end(), bodies) == pairs.end()) {
      continue;
    }
    Plane& plane = pair.planes.front();
    const Vector3d apart =
        shifts[static_cast<size_t>(pair.b)] - shifts[static_cast<size_t>(pair.a)];
    const Vector3d side = plane.normal.unitOrthogonal(), other = plane.normal.cross(side);
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * M_PI * i / kDirections;
      const Vector3d normal = std::cos(angle) * side + std::sin(angle) * other;
      const double depth = bodies_->DepthAlong(pair.a, pair.b, apart, normal);
      if (depth >= shallowest) continue;
      shallowest = depth;
      best = normal;
      taken_at = apart;
      replaced = &plane;
    }
  }
  if (replaced) ReplacePlane(best, shallowest, taken_at, replaced);
}

std::vector<SeparationConstraint> ContactPlanes::Rows() const {
  std::vector<SeparationConstraint> rows;
  for (const BodyPair& pair : pairs_) {
    for (const Plane& plane : pair.planes) {
      if (plane.bound >= options_.contact_margin) continue;
      rows.push_back({pair.a, pair.b, plane.normal, plane.least, plane.lambda});
    }
  }
  return rows;
}

void ContactPlanes::SetMultipliers(const std::vector<SeparationConstraint>& rows) {
  auto row = rows.begin();
  for (BodyPair& pair : pairs_) {
    for (Plane& plane : pair.planes) {
      plane.lambda = plane.bound >= options_.contact_margin ? 0.0 : (row++)->lambda;
    }
  }
}

std::vector<Overlap> ContactPlanes::Overlaps() const {
  std::vector<Overlap> overlaps;
  for (const BodyPair& pair : pairs_) {
    const double deepest = Deepest(pair);
    if (deepest > options_.tolerance) overlaps.push_back({pair.a, pair.b, deepest});
  }
  std::stable_sort(overlaps.begin(), overlaps.end(),
                   [](const Overlap& a, const Overlap& b) { return a.depth > b.depth; });
  return overlaps;
}

}  // namespace simwright::scene
