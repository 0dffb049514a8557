// Convex parts for tests.
#pragma once

#include <vector>

#include "geometry/distance.h"

namespace simwright::scene {

inline geometry::ConvexShape Box(const Eigen::Vector3d& size,
                                 const Eigen::Vector3d& center = Eigen::Vector3d::Zero()) {
  geometry::ConvexShape shape;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    shape.vertices.push_back(center + corner.cwiseProduct(size));
  }
  return shape;
}

inline geometry::ConvexShape Ball(double radius) {
  return {{Eigen::Vector3d::Zero()}, radius};
}

}  // namespace simwright::scene
