#include "twin/plane_hull.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace simwright::twin {
namespace {

double Turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

}  // namespace

PlaneHull::PlaneHull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  // The lower chain from left to right, then the upper one back.
  const auto append = [this](const Eigen::Vector2d& point, size_t first) {
    while (corners_.size() >= first + 2 &&
           Turn(corners_[corners_.size() - 2], corners_.back(), point) <= 0.0) {
      corners_.pop_back();
    }
    corners_.push_back(point);
  };
  for (const Eigen::Vector2d& point : points) append(point, 0);
  if (corners_.size() < 2) {
    corners_.clear();
    return;
  }
  const size_t turn = corners_.size() - 1;
  for (size_t i = points.size() - 1; i-- > 0;) append(points[i], turn);
  corners_.pop_back();
  if (corners_.size() < 3) corners_.clear();
}

double PlaneHull::DepthInside(const Eigen::Vector2d& point) const {
  if (corners_.empty()) return -std::numeric_limits<double>::infinity();
  double depth = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < corners_.size(); ++i) {
    const Eigen::Vector2d& a = corners_[i];
    const Eigen::Vector2d& b = corners_[(i + 1) % corners_.size()];
    const double length = (b - a).norm();
    if (length > 0.0) depth = std::min(depth, Turn(a, b, point) / length);
  }
  return depth;
}

}  // namespace simwright::twin
