#pragma once

#include <set>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "scene/least_shift.h"
#include "scene/near_parts.h"

namespace simwright::scene {

// Two bodies that are in each other, by index, a < b.
struct Overlap {
  int a = -1, b = -1;
  double depth = 0.0;  // m
};

struct SeparationOptions {
  double influence = 0.03;  // m: parts that are farther apart have no plane
  double tolerance = 1e-5;  // m that parts may be in each other
};

// The planes that keep bodies apart. For two convex parts it is the tangent of their signed
// distance,
//   distance >= normal . (shift_b - shift_a) - least,
// which is a bound from below wherever the bodies go, as that distance is convex in their shift.
// So a plane that holds nothing back stays as it is, and only those that push, or that are not met,
// are taken anew where the bodies have come to.
//
// Two bodies in each other are taken by their parts, or by their hulls where the way out of these
// is the shorter: the walls of two hollow things that are through each other push this way and
// that, and contradict each other.
class SeparationPlanes {
 public:
  // `bodies` outlives this.
  SeparationPlanes(const ConvexBodies* bodies, const SeparationOptions& options)
      : bodies_(bodies), options_(options) {}

  // The planes for bodies shifted by `shifts` (N x 3, m).
  void Update(const std::vector<Eigen::Vector3d>& shifts);

  // Those of parts nearer than `influence`, in the order of a, b, part_a, part_b, with the
  // pressures that SetPressures gave their parts.
  std::vector<SeparationRow> Rows() const;
  void SetPressures(const std::vector<SeparationRow>& rows);  // of Rows()

  // Of the last Update; the deepest first.
  std::vector<Overlap> Overlaps() const;

  // Takes these two by their hulls from the next Update on; false where they already are.
  bool TakeByHull(int a, int b) { return by_hull_.insert({a, b}).second; }
  // Gives one of these pairs, which are taken by their hulls, another plane until the next Update
  // after a shift: level with the present one's tangent and the least deep there is among them.
  // What cannot give way upwards, between two boards, may to the side.
  void TurnOneAcross(const std::vector<std::pair<int, int>>& pairs,
                     const std::vector<Eigen::Vector3d>& shifts);

 private:
  struct Plane {
    int part_a = -1, part_b = -1;
    Eigen::Vector3d normal, taken_at;  // unit; m, the shift of b against a that it touches at
    double least = 0.0, pressure = 0.0;
    double bound = 0.0;  // m, of the distance, from below; itself where it was just taken
  };
  struct BodyPair {
    int a = -1, b = -1;
    std::vector<Plane> planes;  // in order of part_a, part_b; far ones, too, as they are bounds
  };

  void UpdatePair(const std::vector<Eigen::Vector3d>& shifts, BodyPair* pair);
  bool HullIsNearer(const BodyPair& pair, const std::vector<Eigen::Vector3d>& shifts) const;
  double Deepest(const BodyPair& pair) const;

  const ConvexBodies* bodies_;
  SeparationOptions options_;
  std::vector<BodyPair> pairs_;  // in order of a, b
  std::set<std::pair<int, int>> by_hull_;
};

}  // namespace simwright::scene
