#include "geometry/convex_cut.h"

#include <vector>

#include "core/error.h"
#include "geometry/convex_hull.h"

namespace simwright::geometry {

core::TriangleMesh CutConvex(const core::TriangleMesh& convex, const Eigen::Vector3d& normal,
                             double offset, int max_vertices) {
  std::vector<Eigen::Vector3d> points;
  const auto beyond = [&](const Eigen::Vector3d& v) { return normal.dot(v) - offset; };
  for (const Eigen::Vector3d& v : convex.vertices) {
    if (beyond(v) <= 0.0) points.push_back(v);
  }
  for (const Eigen::Vector3i& t : convex.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& a = convex.vertices[static_cast<size_t>(t[k])];
      const Eigen::Vector3d& b = convex.vertices[static_cast<size_t>(t[(k + 1) % 3])];
      const double da = beyond(a), db = beyond(b);
      if (da <= 0.0 && db > 0.0) points.push_back(a + (b - a) * (da / (da - db)));
      if (da > 0.0 && db <= 0.0) points.push_back(b + (a - b) * (db / (db - da)));
    }
  }
  try {
    return ConvexHull(points, max_vertices);
  } catch (const core::Error&) {
    return {};
  }
}

}  // namespace simwright::geometry
