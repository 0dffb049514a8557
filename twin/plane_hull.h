#pragma once

#include <vector>

#include <Eigen/Core>

namespace simwright::twin {

// The convex hull of points of a plane.
class PlaneHull {
 public:
  // By Andrew's monotone chain (1979). Fewer than three points have an empty hull.
  explicit PlaneHull(std::vector<Eigen::Vector2d> points);

  // Returns the distance from the hull's border: positive inside. Of an empty hull, minus infinity.
  double DepthInside(const Eigen::Vector2d& point) const;
  // Returns the corners, counter-clockwise.
  const std::vector<Eigen::Vector2d>& corners() const { return corners_; }

 private:
  std::vector<Eigen::Vector2d> corners_;
};

}  // namespace simwright::twin
