#pragma once

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

  // All pairs of parts nearer than `within` (m) once body i is shifted by shifts[i] (N x 3), in the
  // order of a, b, part_a, part_b. `by_hull(a, b)`: these two bodies are taken by their hulls. The
  // bounding boxes are swept along x.
  template <typename ByHull>
  void Find(const std::vector<Eigen::Vector3d>& shifts, double within, const ByHull& by_hull,
            std::vector<NearParts>* near) const {
    near->clear();
    for (const auto& [a, b] : NearBodies(shifts, within)) {
      FindBetween(a, b, shifts, within, by_hull(a, b), near);
    }
  }

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

  std::vector<std::pair<int, int>> NearBodies(const std::vector<Eigen::Vector3d>& shifts,
                                              double within) const;
  void FindBetween(int a, int b, const std::vector<Eigen::Vector3d>& shifts, double within,
                   bool by_hull, std::vector<NearParts>* near) const;

  std::vector<Body> bodies_;
};

}  // namespace simwright::scene
