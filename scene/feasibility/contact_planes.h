#pragma once

#include <set>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "scene/feasibility/narrow_phase.h"
#include "scene/feasibility/overlap.h"
#include "scene/feasibility/pgs_solver.h"

namespace simwright::scene {

struct ContactPlaneOptions {
  double contact_margin = 0.03;  // m, contact margin: parts farther apart have no plane
  double tolerance = 1e-5;       // m, allowed penetration
};

// The contact planes between bodies. The plane of two convex parts is the tangent of their signed
// distance,
//   distance >= normal . (shift_b - shift_a) - least,
// a lower bound for all displacements, because the distance is convex in them. Planes that are
// inactive and satisfied are therefore kept, and only active or violated ones are recomputed at the
// current displacements.
//
// Two interpenetrating bodies are represented by their parts, or by their hulls if the displacement
// that separates the hulls is shorter: the walls of two hollow bodies that pass through each other
// give contradictory constraints.
class ContactPlanes {
 public:
  // `bodies` outlives this.
  ContactPlanes(const ConvexBodies* bodies, const ContactPlaneOptions& options)
      : bodies_(bodies), options_(options) {}

  // Updates the planes for bodies displaced by `shifts` (N x 3, m).
  void Update(const std::vector<Eigen::Vector3d>& shifts);

  // Returns the constraints of parts closer than `contact_margin`, sorted by a, b, part_a, part_b,
  // with the multipliers of SetMultipliers.
  std::vector<SeparationConstraint> Rows() const;
  void SetMultipliers(const std::vector<SeparationConstraint>& rows);  // as returned by Rows()

  // Returns the overlaps of the last Update, the deepest first.
  std::vector<Overlap> Overlaps() const;

  // Represents two bodies by their hulls from the next Update on; returns false if they already
  // are, or keep their parts.
  bool UseConvexHull(int a, int b) {
    return by_parts_.count({a, b}) == 0 && by_hull_.insert({a, b}).second;
  }
  // Represents two bodies, a < b, by their parts always: one is inside the other.
  void KeepParts(int a, int b) { by_parts_.insert({a, b}); }
  void ReleaseParts(int a, int b) { by_parts_.erase({a, b}); }
  // Replaces the plane of a pair that is represented by its hulls, until the Update after the next
  // displacement: by the one with this unit normal, from a to b. Returns false if the pair has no
  // such plane.
  bool SwitchToNormal(int a, int b, const Eigen::Vector3d& normal,
                      const std::vector<Eigen::Vector3d>& shifts);
  // Replaces the plane of one of these pairs likewise: by a plane with a normal perpendicular to
  // the current one and the least depth over all the pairs. A body that cannot move up, between two
  // boards, can then move sideways.
  void SwitchToLateralNormal(const std::vector<std::pair<int, int>>& pairs,
                             const std::vector<Eigen::Vector3d>& shifts);

 private:
  struct Plane {
    int part_a = -1, part_b = -1;
    Eigen::Vector3d normal, taken_at;  // unit; m, the displacement of b relative to a at the
                                       // tangent point
    double least = 0.0, lambda = 0.0;
    double bound = 0.0;  // m, lower bound of the distance; exact at the tangent point
  };
  struct BodyPair {
    int a = -1, b = -1;
    std::vector<Plane> planes;  // sorted by part_a, part_b; distant ones too, as bounds
  };

  // Replaces a plane by one whose hulls overlap by `depth` (m) at the relative displacement
  // `apart`.
  static void ReplacePlane(const Eigen::Vector3d& normal, double depth,
                           const Eigen::Vector3d& apart, Plane* plane);
  void UpdatePair(const std::vector<Eigen::Vector3d>& shifts, BodyPair* pair);
  bool IsHullSeparationShorter(const BodyPair& pair,
                               const std::vector<Eigen::Vector3d>& shifts) const;
  double Deepest(const BodyPair& pair) const;

  const ConvexBodies* bodies_;
  ContactPlaneOptions options_;
  std::vector<BodyPair> pairs_;  // sorted by a, b
  std::set<std::pair<int, int>> by_hull_, by_parts_;
};

}  // namespace simwright::scene
