#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::pipeline {

// The flat on which a solid stands or lies.
struct Foot {
  Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();  // unit, outward
  double reach = 0.0;                                // m: the solid lies in down . x <= reach
  std::vector<Eigen::Vector3d> corners;              // of the flat; fewer than three: a point
};

// The foot nearest to straight down, within 25 degrees, that bears a tilt of 3 degrees under
// `center_of_mass`; else what is within 0.1 % of the height of the lowest vertex. At most `count`
// corners, evenly spread round a round one. Throws core::Error for an invalid or flat mesh.
Foot FindFoot(const core::TriangleMesh& solid, const Eigen::Vector3d& center_of_mass, int count);

// A hull of few vertices may lose the flat on which a thing stands: corners that lie outside of
// what the parts (convex) have of it go back into the nearest of `parts`, and what lies within
// 0.3 % of the diagonal of the flat (a quarter of the height of a part thinner than that), or
// beyond it, is moved onto it: a foot that is nearly flat chatters. Where the foot is a point, only
// what lies beyond it is. At most 32 corners a part, evenly spread round a round one; one of 7 to
// 15 that stands alone gets more on its sides, which bulge by a thousandth of its width. No part
// gets more than `max_vertices`.
void KeepFoot(const Foot& foot, int max_vertices, std::vector<core::TriangleMesh>* parts);

}  // namespace simwright::pipeline
