#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/distance.h"

namespace simwright::scene {

// A narrow-phase pair: two convex parts of different bodies that are close or interpenetrating.
struct NarrowPhasePair {
  int a = -1, b = -1;                                 // the bodies, a < b
  int part_a = -1, part_b = -1;                       // -1: the body's hull
  double distance = 0.0;                              // m; negative: penetration depth
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, world, from a towards b
};

// Bodies of convex parts that translate but do not rotate: finds the parts that are close. The
// rotations are applied once, so that queries need none.
class ConvexBodies {
 public:
  // Adds a body. `parts`: at least one, each with finite vertices, in the body frame, m. Pairs of
  // fixed bodies are ignored.
  void Add(const std::vector<geometry::ConvexShape>& parts,
           const Eigen::Isometry3d& world_from_body, bool fixed);

  int size() const { return static_cast<int>(bodies_.size()); }
  bool fixed(int body) const { return bodies_[static_cast<size_t>(body)].fixed; }

  int Parts(int body) const {
    return static_cast<int>(bodies_[static_cast<size_t>(body)].parts.size());
  }
  // Returns the AABB of a part (-1: the body's hull) at the body's initial position, m.
  const Eigen::AlignedBox3d& Box(int body, int part) const { return PartOf(body, part).box; }

  // Finds all pairs of parts closer than `within` (m) with body i displaced by shifts[i] (N x 3),
  // sorted by a, b, part_a, part_b.
  void Find(const std::vector<Eigen::Vector3d>& shifts, double within,
            std::vector<NarrowPhasePair>* near) const;

  // Returns all sorted pairs a < b of bodies, not both fixed, whose AABBs are closer than `within`:
  // sweep and prune along x.
  std::vector<std::pair<int, int>> BroadPhasePairs(const std::vector<Eigen::Vector3d>& shifts,
                                                   double within) const;

  // Calls `visit(part_a, part_b)`, in order, for the parts whose AABBs are closer than `within`
  // with b displaced by `apart` relative to a; with `by_hull` only for the hulls, as -1, -1.
  template <typename Visit>
  void ForEachClosePart(int a, int b, const Eigen::Vector3d& apart, double within, bool by_hull,
                        const Visit& visit) const {
    const Body& one = bodies_[static_cast<size_t>(a)];
    const Body& other = bodies_[static_cast<size_t>(b)];
    if (Gap(one.hull.box, other.hull.box, apart) >= within) return;
    if (by_hull) return visit(-1, -1);
    for (size_t p = 0; p < one.parts.size(); ++p) {
      if (Gap(one.parts[p].box, other.hull.box, apart) >= within) continue;
      for (size_t q = 0; q < other.parts.size(); ++q) {
        if (Gap(one.parts[p].box, other.parts[q].box, apart) >= within) continue;
        visit(static_cast<int>(p), static_cast<int>(q));
      }
    }
  }

  // Returns the distance of two parts (-1: the body's hull) with b displaced by `apart` relative to
  // a.
  NarrowPhasePair Distance(int a, int part_a, int b, int part_b,
                           const Eigen::Vector3d& apart) const;

  // Returns the penetration depth of the hulls along a unit `normal` from a to b, m; negative if a
  // plane normal to it separates them.
  double DepthAlong(int a, int b, const Eigen::Vector3d& apart,
                    const Eigen::Vector3d& normal) const;

 private:
  struct Part {
    geometry::ConvexShape shape;  // rotated, relative to the body's initial position, m
    Eigen::AlignedBox3d box;
  };
  struct Body {
    std::vector<Part> parts;
    Part hull;  // of all vertices
    bool fixed = false;
  };

  // Returns the gap of two AABBs along the axis where it is largest, m, negative if they overlap: a
  // lower bound of their distance.
  static double Gap(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b,
                    const Eigen::Vector3d& apart) {
    const Eigen::Vector3d one = (b.min() + apart) - a.max();
    const Eigen::Vector3d other = a.min() - (b.max() + apart);
    return one.cwiseMax(other).maxCoeff();
  }
  const Part& PartOf(int body, int part) const {
    const Body& of = bodies_[static_cast<size_t>(body)];
    return part < 0 ? of.hull : of.parts[static_cast<size_t>(part)];
  }

  std::vector<Body> bodies_;
};

}  // namespace simwright::scene
