#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/distance.h"

namespace simwright::scene {

// Two convex parts of different bodies that are near each other or in each other.
struct NearParts {
  int a = -1, b = -1;            // the bodies, a < b
  int part_a = -1, part_b = -1;  // -1: the body's hull
  double distance = 0.0;         // m; negative: how deep they are in each other
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, world, from a towards b
};

// Bodies of convex parts that move without turning: finds which parts are near. Turned once, so
// that a search costs no product with a rotation.
class ConvexBodies {
 public:
  // Adds a body. `parts` (at least one, each with vertices, finite) in the body's frame, m.
  // A fixed body is not compared with other fixed ones.
  void Add(const std::vector<geometry::ConvexShape>& parts,
           const Eigen::Isometry3d& world_from_body, bool fixed);

  int size() const { return static_cast<int>(bodies_.size()); }
  bool fixed(int body) const { return bodies_[static_cast<size_t>(body)].fixed; }

  int Parts(int body) const {
    return static_cast<int>(bodies_[static_cast<size_t>(body)].parts.size());
  }
  // Of a part (-1: the body's hull) at the body's first place, m.
  const Eigen::AlignedBox3d& Box(int body, int part) const { return PartOf(body, part).box; }

  // All pairs of parts nearer than `within` (m) once body i is shifted by shifts[i] (N x 3), in the
  // order of a, b, part_a, part_b.
  void Find(const std::vector<Eigen::Vector3d>& shifts, double within,
            std::vector<NearParts>* near) const;

  // All pairs a < b of bodies, not both fixed, whose bounding boxes are nearer than `within`, in
  // order: the boxes are swept along x.
  std::vector<std::pair<int, int>> NearBodies(const std::vector<Eigen::Vector3d>& shifts,
                                              double within) const;

  // `visit(part_a, part_b)`, in order, for those whose bounding boxes are nearer than `within` once
  // b is shifted by `apart` against a; by_hull: of the hulls alone, as -1, -1.
  template <typename Visit>
  void ForPartsNear(int a, int b, const Eigen::Vector3d& apart, double within, bool by_hull,
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

  // Of two parts (-1: the body's hull) once b is shifted by `apart` against a.
  NearParts Distance(int a, int part_a, int b, int part_b, const Eigen::Vector3d& apart) const;

  // How deep the hulls are in each other along a unit `normal` from a to b, m; less than 0 where
  // the planes across it part them.
  double DepthAlong(int a, int b, const Eigen::Vector3d& apart,
                    const Eigen::Vector3d& normal) const;

 private:
  struct Part {
    geometry::ConvexShape shape;  // turned, from the body's first place, m
    Eigen::AlignedBox3d box;
  };
  struct Body {
    std::vector<Part> parts;
    Part hull;  // of all vertices
    bool fixed = false;
  };

  // m between two boxes along the axis on which they are farthest apart, less than 0 where they
  // overlap: no more than their distance.
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
