#include "library/convex_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/convex_hull.h"

namespace simwright::library {
namespace {

// Adds the points of a circle about `center`, perpendicular to `direction`, projected along it onto
// the plane with `normal`.
void AddRing(const Eigen::Vector3d& center, const Eigen::Vector3d& direction, double radius,
             const Eigen::Vector3d& normal, int segments, std::vector<Eigen::Vector3d>* points) {
  const Eigen::Vector3d side = direction.unitOrthogonal();
  const Eigen::Vector3d other = direction.cross(side);
  for (int i = 0; i < segments; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / segments;
    const Eigen::Vector3d spoke = radius * (std::cos(angle) * side + std::sin(angle) * other);
    // Shift along the segment to the cutting plane.
    const double shift = -spoke.dot(normal) / direction.dot(normal);
    points->push_back(center + spoke + shift * direction);
  }
}

}  // namespace

core::TriangleMesh Box(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double bevel) {
  const Eigen::Vector3d low = a.cwiseMin(b), high = a.cwiseMax(b);
  const double cut = std::min(bevel, 0.25 * (high - low).minCoeff());
  std::vector<Eigen::Vector3d> points;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d tip, inward;
    for (int axis = 0; axis < 3; ++axis) {
      const bool top = corner & (1 << axis);
      tip[axis] = top ? high[axis] : low[axis];
      inward[axis] = top ? -cut : cut;
    }
    if (cut <= 0.0) {
      points.push_back(tip);
      continue;
    }
    // One point on each of the three faces that meet at this corner.
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d point = tip + inward;
      point[axis] = tip[axis];
      points.push_back(point);
    }
  }
  return geometry::ConvexHull(points);
}

core::TriangleMesh Frustum(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double first,
                           double last, int segments) {
  const Eigen::Vector3d direction = (to - from).normalized();
  std::vector<Eigen::Vector3d> points;
  AddRing(from, direction, first, direction, segments, &points);
  AddRing(to, direction, last, direction, segments, &points);
  return geometry::ConvexHull(points);
}

core::TriangleMesh Rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
                       int segments) {
  return Frustum(from, to, radius, radius, segments);
}

core::TriangleMesh Hull(const std::vector<Eigen::Vector3d>& points) {
  return geometry::ConvexHull(points);
}

std::vector<core::TriangleMesh> Pipe(const std::vector<Eigen::Vector3d>& path, double radius,
                                     int segments) {
  std::vector<core::TriangleMesh> legs;
  const size_t count = path.size() - 1;
  const auto direction = [&](size_t leg) -> Eigen::Vector3d {
    return (path[leg + 1] - path[leg]).normalized();
  };
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d along = direction(i);
    const Eigen::Vector3d before = i > 0 ? (direction(i - 1) + along).normalized() : along;
    const Eigen::Vector3d after = i + 1 < count ? (along + direction(i + 1)).normalized() : along;
    std::vector<Eigen::Vector3d> points;
    AddRing(path[i], along, radius, before, segments, &points);
    AddRing(path[i + 1], along, radius, after, segments, &points);
    legs.push_back(geometry::ConvexHull(points));
  }
  return legs;
}

std::vector<Eigen::Vector3d> Arc(const Eigen::Vector3d& center, const Eigen::Vector3d& from,
                                 const Eigen::Vector3d& axis, double angle, int steps) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= steps; ++i) {
    points.push_back(center + Eigen::AngleAxisd(angle * i / steps, axis) * (from - center));
  }
  return points;
}

}  // namespace simwright::library
