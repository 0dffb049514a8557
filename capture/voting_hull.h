#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "asset_lift/camera/observed_view.h"
#include "core/mesh.h"

namespace simwright::capture {

// Masks of which each point of the object lies in all but a few.
struct HullVote {
  std::vector<asset_lift::ObservedView> views;
  int tolerated = 1;  // views whose masks may exclude a point of the object
};

struct VotingHullOptions {
  int cells = 64;      // along the longest side of the box
  double floor = 0.0;  // m: the object stands on this height; nothing is below it
  // Cells by which the hull is grown, so that parts thinner than a cell stay.
  double margin = 0.0;
  // Other planes on which the object stood: nothing is on their negative side.
  std::vector<Eigen::Hyperplane<double, 3>> planes = {};
};

// Returns the points of `box` (world, m) that every vote admits: a visual hull that a few wrong
// masks do not cut. Closed, oriented, flat on the floor; components under a hundredth of the
// largest one's volume are removed. Empty if nothing is inside. Throws core::Error for invalid
// views, a vote with no more views than it tolerates, or fewer than 8 cells; core::Cancelled.
core::TriangleMesh VotingHull(const std::vector<HullVote>& votes, const Eigen::AlignedBox3d& box,
                              const VotingHullOptions& options);

}  // namespace simwright::capture
