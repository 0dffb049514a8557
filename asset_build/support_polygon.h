#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::asset_build {

// The support polygon of a solid.
struct SupportPolygon {
  Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();  // unit, outward
  double reach = 0.0;                                // the solid lies in down . x <= reach, m
  std::vector<Eigen::Vector3d> corners;              // fewer than three: a single contact point
};

// Returns the support polygon whose outward normal is closest to straight down, within 25 degrees,
// and that withstands a tilt of 3 degrees with this `center_of_mass`; if there is none, the points
// within 0.1 % of the height above the lowest vertex. Has at most `count` corners, evenly spread
// around a round face. Throws core::Error for an invalid or flat mesh.
SupportPolygon FindSupportPolygon(const core::TriangleMesh& solid,
                                  const Eigen::Vector3d& center_of_mass, int count);

// Restores the support face that hulls with few vertices may lose. Corners of `support` that the
// convex `parts` no longer contain are added to the nearest part. Vertices within 0.3 % of the
// diagonal of the face (within a quarter of the height of a thinner part), or beyond it, are moved
// onto it, because a nearly flat support face chatters. If the support is a single point, only
// vertices beyond it are moved. Adds at most 32 corners per part, evenly spread around a round
// face; a round face of 7 to 15 corners that is alone gets more corners on its sides, which bulge
// by a thousandth of its width. No part exceeds `max_vertices`.
void PreserveSupportFace(const SupportPolygon& support, int max_vertices,
                         std::vector<core::TriangleMesh>* parts);

}  // namespace simwright::asset_build
