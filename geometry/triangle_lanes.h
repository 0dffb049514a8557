#pragma once

#include <limits>

#include <Eigen/Core>

#include "core/lanes.h"
#include "geometry/triangle_tree.h"

namespace simwright::geometry {

// Tests of four triangles or AABBs of a TriangleTree at once. All functions are inlined: they are
// compiled for the instructions of their caller. None returns Lanes, which would depend on these.
#define SIMWRIGHT_INLINE __attribute__((always_inline)) inline

struct LaneVector {
  core::Lanes x, y, z;
};

SIMWRIGHT_INLINE LaneVector LaneVectorAt(const double (&rows)[3][core::kLanes]) {
  LaneVector lanes;
  core::LoadLanes(rows[0], &lanes.x);
  core::LoadLanes(rows[1], &lanes.y);
  core::LoadLanes(rows[2], &lanes.z);
  return lanes;
}

SIMWRIGHT_INLINE LaneVector Minus(const LaneVector& a, const LaneVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

SIMWRIGHT_INLINE LaneVector Minus(const Eigen::Vector3d& a, const LaneVector& b) {
  return {a.x() - b.x, a.y() - b.y, a.z() - b.z};
}

// Sets the scalar products, summed in the order of Eigen's where that vectorizes (SSE2).
SIMWRIGHT_INLINE void Dot(const LaneVector& a, const LaneVector& b, core::Lanes* product) {
  *product = a.x * b.x + a.y * b.y + a.z * b.z;
}

SIMWRIGHT_INLINE LaneVector Cross(const LaneVector& a, const LaneVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename Mask>
SIMWRIGHT_INLINE LaneVector Choose(const Mask& mask, const LaneVector& a, const LaneVector& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

// Sets the squared distances of `p` to the four triangles, m^2, with the operations of
// ClosestPointOnTriangle and therefore the same rounding; NaN for a missing triangle.
SIMWRIGHT_INLINE void SquaredDistances(const TriangleLanes& triangles, const Eigen::Vector3d& p,
                                       double* squared) {
  using core::Lanes;
  const LaneVector a = LaneVectorAt(triangles.a), b = LaneVectorAt(triangles.b),
                   c = LaneVectorAt(triangles.c);
  const LaneVector ab = Minus(b, a), ac = Minus(c, a);
  const LaneVector ap = Minus(p, a), bp = Minus(p, b), cp = Minus(p, c);
  Lanes d1, d2, d3, d4, d5, d6;
  Dot(ab, ap, &d1);
  Dot(ac, ap, &d2);
  Dot(ab, bp, &d3);
  Dot(ac, bp, &d4);
  Dot(ab, cp, &d5);
  Dot(ac, cp, &d6);
  const Lanes va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  const Lanes along_b = d4 - d3, along_c = d5 - d6, sum = va + vb + vc;
  // The regions exclude each other in the order of ClosestPointOnTriangle.
  const auto at_a = (d1 <= 0.0) & (d2 <= 0.0);
  const auto at_b = ~at_a & (d3 >= 0.0) & (d4 <= d3);
  const auto not_ab = at_a | at_b;
  const auto on_ab = ~not_ab & (vc <= 0.0) & (d1 >= 0.0) & (d3 <= 0.0);
  const auto not_c = not_ab | on_ab;
  const auto at_c = ~not_c & (d6 >= 0.0) & (d5 <= d6);
  const auto not_ac = not_c | at_c;
  const auto on_ac = ~not_ac & (vb <= 0.0) & (d2 >= 0.0) & (d6 <= 0.0);
  const auto not_bc = not_ac | on_ac;
  const auto on_bc = ~not_bc & (va <= 0.0) & (along_b >= 0.0) & (along_c >= 0.0);
  const auto within = ~(not_bc | on_bc) & (sum > 0.0);
  // base + share * side + share_c * ac
  const LaneVector base = Choose(at_c, c, Choose(at_b | on_bc, b, a));
  const LaneVector side = Choose(on_bc, Minus(c, b), Choose(on_ac, ac, ab));
  const Lanes part = on_bc ? along_b : on_ac ? d2 : on_ab ? d1 : vb;
  const Lanes whole = on_bc ? along_b + along_c : on_ac ? d2 - d6 : on_ab ? d1 - d3 : sum;
  const Lanes none = {};
  const Lanes share = (on_bc | on_ac | on_ab | within) ? part / whole : none;
  const Lanes share_c = within ? vc / sum : none;
  const LaneVector apart = {base.x + share * side.x + share_c * ac.x - p.x(),
                            base.y + share * side.y + share_c * ac.y - p.y(),
                            base.z + share * side.z + share_c * ac.z - p.z()};
  Lanes sum_of_squares;
  Dot(apart, apart, &sum_of_squares);
  core::StoreLanes(sum_of_squares, squared);
}

// Sets the ray parameters t >= 0 at which origin + t * direction meets the four triangles, from
// either side, borders included (Moeller and Trumbore 1997); infinity where it does not.
SIMWRIGHT_INLINE void Hits(const TriangleLanes& triangles, const Eigen::Vector3d& origin,
                           const Eigen::Vector3d& direction, double* t) {
  using core::Lanes;
  constexpr double kSlack = 1e-12;
  const Lanes zero = {};
  const LaneVector a = LaneVectorAt(triangles.a);
  const LaneVector ab = Minus(LaneVectorAt(triangles.b), a);
  const LaneVector ac = Minus(LaneVectorAt(triangles.c), a);
  const LaneVector along = {zero + direction.x(), zero + direction.y(), zero + direction.z()};
  const LaneVector p = Cross(along, ac);
  const LaneVector s = Minus(origin, a);
  const LaneVector q = Cross(s, ab);
  Lanes determinant, u, v, at;
  Dot(ab, p, &determinant);
  Dot(s, p, &u);
  Dot(along, q, &v);
  Dot(ac, q, &at);
  const Lanes inverse = 1.0 / determinant;
  u *= inverse;
  v *= inverse;
  at *= inverse;
  const Lanes never = zero + std::numeric_limits<double>::infinity();
  const auto hit = (determinant != 0.0) & (u >= -kSlack) & (u <= 1.0 + kSlack) & (v >= -kSlack) &
                   (u + v <= 1.0 + kSlack) & (at >= 0.0);
  core::StoreLanes(hit ? at : never, t);
}

// Sets the squared distances of `p` to the four AABBs, m^2.
SIMWRIGHT_INLINE void SquaredDistances(const BoxLanes& boxes, const Eigen::Vector3d& p,
                                       double* squared) {
  using core::Lanes;
  Lanes sum = {};
  const Lanes zero = {};
  for (int k = 0; k < 3; ++k) {
    Lanes low, high;
    core::LoadLanes(boxes.low[k], &low);
    core::LoadLanes(boxes.high[k], &high);
    const Lanes below = low - p[k], above = p[k] - high;
    const Lanes farther = below > above ? below : above;
    const Lanes outside = farther > 0.0 ? farther : zero;
    sum += outside * outside;
  }
  core::StoreLanes(sum, squared);
}

// Sets the ray parameters in [0, reach] at which a ray enters the four AABBs; infinity where it
// does not. `inverse` is 1 / direction.
SIMWRIGHT_INLINE void Entries(const BoxLanes& boxes, const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& inverse, double reach, double* entries) {
  using core::Lanes;
  const Lanes zero = {};
  const Lanes never = zero + std::numeric_limits<double>::infinity();
  Lanes enter = zero, leave = zero + reach;
  for (int k = 0; k < 3; ++k) {
    const bool backwards = inverse[k] < 0.0;
    Lanes near, far;
    core::LoadLanes((backwards ? boxes.high : boxes.low)[k], &near);
    core::LoadLanes((backwards ? boxes.low : boxes.high)[k], &far);
    near = (near - origin[k]) * inverse[k];
    far = (far - origin[k]) * inverse[k];
    // NaN (a ray within a slab's plane) keeps the interval unchanged.
    enter = near > enter ? near : enter;
    leave = far < leave ? far : leave;
  }
  // The margin compensates for rounding.
  core::StoreLanes(enter <= leave * (1.0 + 1e-14) + 1e-300 ? enter : never, entries);
}

#undef SIMWRIGHT_INLINE

}  // namespace simwright::geometry
