#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "certificate/placed_scene.h"
#include "geometry/distance.h"

namespace simwright::certificate {

// A convex shape at a pose, with its AABB. World frame.
struct PlacedShape {
  geometry::ConvexShape shape;
  Eigen::AlignedBox3d box;

  // Moves `local` to `pose`, reusing memory.
  void Place(const geometry::ConvexShape& local, const Eigen::Isometry3d& pose);
};

// The convex parts of the bodies of a scene as obstacles.
class Obstacles {
 public:
  explicit Obstacles(const PlacedScene& scene);

  // Ignores a body in Hit (true), or does not (false).
  void Ignore(int body, bool ignored) { ignored_[static_cast<size_t>(body)] = ignored; }
  // Returns the first body that is within `margin` (m) of the shape; -1: none. Ignores the bodies
  // that are flagged in `also_ignored`, too.
  int Hit(const PlacedShape& shape, double margin,
          const std::vector<char>* also_ignored = nullptr) const;
  // Sets the flag of each body within `margin` of the shape.
  void Mark(const PlacedShape& shape, double margin, std::vector<char>* near) const;

 private:
  struct Part {
    PlacedShape placed;
    int body = -1;
  };
  std::vector<Part> parts_;
  std::vector<char> ignored_;  // by body
};

}  // namespace simwright::certificate
