#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/distance.h"
#include "scene/feasibility/kept_relation.h"
#include "scene/feasibility/overlap.h"

namespace simwright::scene {

// A body of the projection.
struct ProjectedBody {
  // Convex parts, m, in the body frame; not null. Many bodies may share them.
  const std::vector<geometry::ConvexShape>* parts = nullptr;
  Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();
  bool fixed = false;  // welded furniture: never moves, may overlap other furniture
};

struct DepenetrationOptions {
  // The contact margin, m: pairs of parts farther apart are ignored; the next round picks up pairs
  // that approach. A smaller margin needs more rounds.
  double contact_margin = 0.03;
  // The remaining penetration of parts, m. A tenth of what a scene may have, so that numbers
  // written in single precision still pass.
  double tolerance = 1e-5;
  double settled = 1e-5;  // m: converged when no body moves farther in a round
  int rounds = 40;        // most linearizations; stacks of five take about ten

  bool IsValid(std::string* error) const;
};

struct Projection {
  bool feasible = false;                // true if no penetration exceeds the tolerance
  std::vector<Eigen::Vector3d> shifts;  // (N x 3) m, world; zero for fixed bodies
  std::vector<Overlap> overlaps;        // the deepest first; empty if feasible
  std::vector<int> broken;              // indices of the relations that do not hold, ascending
  double cost = 0.0;                    // m^2, the sum of squared shifts
  int rounds = 0;
};

// Resolves the penetrations of bodies with the least sum of squared displacements, rotations kept:
//   min sum |p_i - p_i0|^2  with  d(part of i, part of j) >= 0  for every pair of parts,
// one constraint per pair, so that bodies in contact touch exactly. The signed distance of two
// convex parts is convex in their displacement, so that its tangent at any point, d + n . dp, is a
// lower bound: the quadratic program of a round keeps the tangents above zero, and the next round
// linearizes again at its solution (ContactPlanes). The program is solved in its dual,
// constraint by constraint (Hildreth 1957). `relations` are further constraints, linearized like
// contacts (LinearizeRelation); where not all constraints can hold, relations are given up one by
// one, the most strained first, and what does not hold in the end is listed. If there is no
// solution, the result is the best one found, with its overlaps. Throws core::Error for invalid
// options, a body without parts, relations of bodies that do not exist, or numbers that are not
// finite. Scales to thousands of bodies; distant parts cost nothing.
Projection ResolvePenetrations(const std::vector<ProjectedBody>& bodies,
                               const DepenetrationOptions& options = {},
                               const std::vector<KeptRelation>& relations = {});

}  // namespace simwright::scene
