// Compares this project's planar convex hull (geometry/convex_hull_2d.h) with CGAL's
// ch_graham_andrew on exact predicates.
//   bench_hull_2d_table
// Columns: the mean time of a call; the hull's corners; and the points that lie outside of an edge
// in exact arithmetic.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/ch_graham_andrew.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "core/random.h"
#include "geometry/convex_hull_2d.h"

namespace simwright::bench {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Points Square(int count, core::Rng& rng) {
  Points points;
  for (int i = 0; i < count; ++i) points.emplace_back(core::Uniform(rng), core::Uniform(rng));
  return points;
}

Points Circle(int count, core::Rng& rng) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * core::Uniform(rng);
    points.emplace_back(std::cos(angle), std::sin(angle));
  }
  return points;
}

// Returns points on the sides of a turned square: collinear within rounding.
Points Sides(int count, core::Rng& rng) {
  const Eigen::Rotation2Dd turn(0.7);
  Points points;
  for (int i = 0; i < count; ++i) {
    const double along = core::Uniform(rng), side = i % 2;
    points.push_back(turn * (i % 4 < 2 ? Vector2d(along, side) : Vector2d(side, along)));
  }
  return points;
}

Points Cgal(const Points& points) {
  std::vector<Kernel::Point_2> given, corners;
  given.reserve(points.size());
  for (const Vector2d& p : points) given.emplace_back(p.x(), p.y());
  CGAL::ch_graham_andrew(given.begin(), given.end(), std::back_inserter(corners), Kernel());
  Points hull;
  for (const Kernel::Point_2& p : corners) hull.emplace_back(p.x(), p.y());
  return hull;
}

int OutsideExactly(const Points& hull, const Points& points) {
  int outside = 0;
  for (const Vector2d& p : points) {
    bool inside = true;
    for (std::size_t i = 0; i < hull.size() && inside; ++i) {
      const Vector2d &a = hull[i], &b = hull[(i + 1) % hull.size()];
      inside = CGAL::orientation(Kernel::Point_2(a.x(), a.y()), Kernel::Point_2(b.x(), b.y()),
                                 Kernel::Point_2(p.x(), p.y())) != CGAL::RIGHT_TURN;
    }
    outside += !inside;
  }
  return outside;
}

struct PointSet {
  const char* name;
  Points (*make)(int count, core::Rng& rng);
};

struct Method {
  const char* name;
  Points (*hull)(const Points& points);
};

Points Ours(const Points& points) {
  return geometry::ConvexHull2d(points);
}

void PrintRow(const PointSet& set, const Points& points, const Method& method) {
  Points hull;
  int calls = 0;
  std::chrono::duration<double> passed{0.0};
  const auto start = std::chrono::steady_clock::now();
  while (passed.count() < 0.2 || calls < 3) {
    hull = method.hull(points);
    ++calls;
    passed = std::chrono::steady_clock::now() - start;
  }
  std::printf("%-7s %7zu %-6s %10.2f %8zu %8d\n", set.name, points.size(), method.name,
              1e6 * passed.count() / calls, hull.size(), OutsideExactly(hull, points));
  std::fflush(stdout);
}

}  // namespace
}  // namespace simwright::bench

int main() {
  using namespace simwright::bench;
  const PointSet sets[] = {{"square", Square}, {"circle", Circle}, {"sides", Sides}};
  const Method methods[] = {{"ours", Ours}, {"CGAL", Cgal}};
  std::printf("%-7s %7s %-6s %10s %8s %8s\n", "set", "points", "method", "us", "corners",
              "outside");
  for (const PointSet& set : sets) {
    for (int count = 10; count <= 10000; count *= 10) {
      simwright::core::Rng rng = simwright::core::StreamRng(5, count);
      const Points points = set.make(count, rng);
      for (const Method& method : methods) PrintRow(set, points, method);
    }
  }
  return 0;
}
