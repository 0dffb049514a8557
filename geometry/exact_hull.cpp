#include "geometry/exact_hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>

#include "geometry/surface_mesh.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

core::TriangleMesh HullOfAll(const std::vector<Vector3d>& points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> given;
  given.reserve(points.size());
  for (const Vector3d& p : points) given.emplace_back(p.x(), p.y(), p.z());
  CGAL::Surface_mesh<Kernel::Point_3> surface;
  CGAL::convex_hull_3(given.begin(), given.end(), surface);
  // Three corners or fewer, or a polygon: the points are flat.
  if (surface.number_of_vertices() < 4 || surface.number_of_faces() < 4) return {};
  return FromSurfaceMesh(surface);
}

// Selects points by farthest-point sampling; the first is the farthest from the mean.
std::vector<Vector3d> FarthestPoints(const std::vector<Vector3d>& points, std::size_t count) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : points) mean += p / static_cast<double>(points.size());
  std::vector<double> distance(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) distance[i] = (points[i] - mean).squaredNorm();
  std::vector<Vector3d> taken;
  while (taken.size() < count) {
    const auto next = std::max_element(distance.begin(), distance.end());
    taken.push_back(points[static_cast<std::size_t>(next - distance.begin())]);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double apart = (points[i] - taken.back()).squaredNorm();
      distance[i] = taken.size() == 1 ? apart : std::min(distance[i], apart);
    }
  }
  return taken;
}

}  // namespace

core::TriangleMesh ExactHull(const std::vector<Vector3d>& points, int max_vertices) {
  core::TriangleMesh hull = HullOfAll(points);
  const std::size_t most = static_cast<std::size_t>(std::max(max_vertices, 0));
  if (most == 0 || hull.vertices.size() <= most) return hull;
  return HullOfAll(FarthestPoints(hull.vertices, most));
}

}  // namespace simwright::geometry
