#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/distance.h"
#include "scene/separation_planes.h"

namespace simwright::scene {

// A thing among those that are moved apart.
struct ProjectedBody {
  // Convex parts, m, in the body's frame; not null. Many bodies may share them.
  const std::vector<geometry::ConvexShape>* parts = nullptr;
  Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();
  bool fixed = false;  // welded furniture: stays where it is, and may be in other furniture
};

struct ProjectionOptions {
  // m: parts that are farther apart are let be. What comes nearer on its way is found by the next
  // round; smaller, there would be more of these.
  double influence = 0.03;
  // m that parts may still be in each other. A tenth of what a scene may have, so that figures
  // written in single precision still pass.
  double tolerance = 1e-5;
  double settled = 1e-5;  // m: a round that moves every body by less is the last
  int rounds = 40;        // of linearising anew, at most; stacks of five take about ten

  bool IsValid(std::string* error) const;
};

struct Projection {
  bool feasible = false;                // none is in another by more than the tolerance
  std::vector<Eigen::Vector3d> shifts;  // (N x 3) m, world; zero of what is fixed
  std::vector<Overlap> overlaps;        // the deepest first; empty where feasible
  double cost = 0.0;                    // m^2, the sum of squared shifts
  int rounds = 0;
};

// Moves things apart by the least sum of squared shifts, rotations kept:
//   min sum |p_i - p_i0|^2  with  d(part of i, part of j) >= 0  for every pair of parts,
// one constraint a pair, so that what touches in the end truly touches. The signed distance of two
// convex parts is convex in their shift, so that its tangent at any place, d + n . dp, is a bound
// from below: a round's quadratic programme keeps the tangents above zero, and the next takes them
// anew where it has come to (SeparationPlanes). The programme is solved in its dual, row by row
// (Hildreth 1957). Where there is no solution, what comes back is the least bad that was found,
// with its overlaps. Throws core::Error for options that are not valid, a body without parts, or
// numbers that are not finite. Bodies: none or thousands; parts that are far apart cost nothing.
Projection ProjectApart(const std::vector<ProjectedBody>& bodies,
                        const ProjectionOptions& options = {});

}  // namespace simwright::scene
