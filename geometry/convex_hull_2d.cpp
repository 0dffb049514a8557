#include "geometry/convex_hull_2d.h"

#include <algorithm>
#include <cmath>

namespace simwright::geometry {
namespace {

using Eigen::Vector2d;

double TwiceArea(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

}  // namespace

std::vector<Vector2d> ConvexHull2d(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const Vector2d& p : points) {
      while (hull.size() >= start + 2) {
        const Vector2d a = hull.back() - hull[hull.size() - 2];
        const Vector2d b = p - hull.back();
        if (a.x() * b.y() - a.y() * b.x() > 0.0) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::vector<Vector2d> SimplifyConvexPolygon(std::vector<Vector2d> polygon, int most, double share) {
  double area = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    area += std::abs(TwiceArea(polygon[0], polygon[i - 1], polygon[i]));
  }
  double lost = 0.0;
  while (polygon.size() > 3) {
    const std::size_t n = polygon.size();
    std::size_t least = 0;
    double cost = INFINITY;
    for (std::size_t i = 0; i < n; ++i) {
      const double ear =
          std::abs(TwiceArea(polygon[(i + n - 1) % n], polygon[i], polygon[(i + 1) % n]));
      if (ear >= cost) continue;
      cost = ear;
      least = i;
    }
    if (n <= static_cast<std::size_t>(std::max(most, 3)) && lost + cost > share * area) break;
    lost += cost;
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(least));
  }
  return polygon;
}

}  // namespace simwright::geometry
