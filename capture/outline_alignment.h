#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "capture/capture.h"
#include "capture/distance_grid.h"

namespace simwright::capture {

// The outlines and the hull of a set of photos, for the alignment with another set.
struct OutlineSet {
  // Rays through the outlines of the masks, as their points near the hull. The object touches each
  // ray at one of them.
  std::vector<std::vector<Eigen::Vector3d>> rays;
  std::vector<Eigen::Vector3d> surface;  // samples of the hull
  DistanceGrid distance;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // of the hull's volume
  double diagonal = 0.0;                             // m
};
OutlineSet OutlinesOf(const Capture& capture);

// A pose of the second set's object in the first set's frame.
struct OutlinePose {
  Eigen::Isometry3d first_from_second = Eigen::Isometry3d::Identity();
  // The mean distance by which the outline rays of each set miss the other set's hull, in diagonals
  // of the hull, at most kMostMismatch a ray. 0: each hull can be the other's.
  double mismatch = 1.0;
};
constexpr double kMostMismatch = 0.05;

// Returns the poses in which the outlines of both sets agree best, the best first, at least 12
// degrees from each other: rotations from all of SO(3) are compared by the hulls, and the best of
// them refined by the outlines (Gauss-Newton with a robust loss). At most `count`.
std::vector<OutlinePose> AlignOutlines(const OutlineSet& first, const OutlineSet& second, int count,
                                       std::uint64_t seed);

// Refines one pose by the outlines.
OutlinePose RefineByOutlines(const OutlineSet& first, const OutlineSet& second, OutlinePose pose);

}  // namespace simwright::capture
