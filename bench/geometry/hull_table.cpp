// Compares this project's convex hull (geometry/convex_hull.h) with qhull (option Qt) and with
// CGAL's convex_hull_3 (geometry/exact_hull.h) on sets of 100 to 100,000 points.
//   bench_hull_table [--largest N]
// Columns: the median time of a call; the hull's vertices; the largest distance of a point outside
// of a face over the diagonal of the points (of 2000 points where there are more); the difference
// of the volume from CGAL's, whose predicates are exact; whether the mesh is closed and manifold;
// and its triangles without area.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/random.h"
#include "geometry/convex_hull.h"
#include "geometry/exact_hull.h"
#include "geometry/mesh_validity.h"
#include "geometry/weld.h"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace simwright::bench {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr std::size_t kProbes = 2000;  // points that are compared with all faces

struct PointSet {
  const char* name;
  Points (*make)(int count, core::Rng& rng);
};

Points Ball(int count, core::Rng& rng) {
  Points points;
  for (int i = 0; i < count; ++i) {
    points.push_back(std::cbrt(core::Uniform(rng)) * core::UniformDirection(rng));
  }
  return points;
}

Points OnSphere(int count, core::Rng& rng) {
  Points points;
  for (int i = 0; i < count; ++i) points.push_back(core::UniformDirection(rng));
  return points;
}

// Returns a cubic grid, rotated so that its faces are flat only within rounding.
Points Grid(int count, core::Rng& rng) {
  const int side = std::max(2, static_cast<int>(std::lround(std::cbrt(count))));
  const Eigen::AngleAxisd turn(core::Uniform(rng, 0.1, 3.0), core::UniformDirection(rng));
  Points points;
  for (int i = 0; i < side * side * side; ++i) {
    points.push_back(turn * Vector3d(i % side, i / side % side, i / (side * side)));
  }
  return points;
}

// Returns points in a plate a thousand times as wide as thick.
Points Plate(int count, core::Rng& rng) {
  const Eigen::AngleAxisd turn(core::Uniform(rng, 0.1, 3.0), core::UniformDirection(rng));
  Points points;
  for (int i = 0; i < count; ++i) {
    const double x = core::Uniform(rng), y = core::Uniform(rng);
    points.push_back(turn * Vector3d(x, y, 1e-3 * core::Uniform(rng)));
  }
  return points;
}

core::TriangleMesh Ours(const Points& points) {
  return geometry::ConvexHull(points);
}

core::TriangleMesh Cgal(const Points& points) {
  return geometry::ExactHull(points, 0);
}

core::TriangleMesh Qhull(const Points& points) {
  std::vector<coordT> coordinates;
  for (const Vector3d& p : points) coordinates.insert(coordinates.end(), p.data(), p.data() + 3);
  qhT state;
  qhT* qh = &state;
  qh_zero(qh, stderr);
  std::string command = "qhull Qt";
  const int failed = qh_new_qhull(qh, 3, static_cast<int>(points.size()), coordinates.data(), False,
                                  command.data(), nullptr, stderr);
  core::TriangleMesh hull;
  std::vector<int> index(points.size(), -1);
  if (!failed) {
    facetT* facet;
    FORALLfacets {
      vertexT *vertex, **vertexp;
      Eigen::Vector3i triangle;
      int corner = 0;
      FOREACHvertex_(facet->vertices) {
        const int id = qh_pointid(qh, vertex->point);
        if (index[id] < 0) {
          index[id] = static_cast<int>(hull.vertices.size());
          hull.vertices.push_back(points[id]);
        }
        if (corner < 3) triangle[corner++] = index[id];
      }
      if ((facet->toporient ^ qh_ORIENTclock) != 0) std::swap(triangle[0], triangle[1]);
      hull.triangles.push_back(triangle);
    }
  }
  qh_freeqhull(qh, !qh_ALL);
  int blocks = 0, bytes = 0;
  qh_memfreeshort(qh, &blocks, &bytes);
  if (failed) throw core::Error("qhull failed", "hull table");
  geometry::OrientConsistently(&hull);
  return hull;
}

struct Method {
  const char* name;
  core::TriangleMesh (*hull)(const Points&);
};

// Returns the median time of a call (s) over at least 0.3 s, and the hull.
double MedianSeconds(const Method& method, const Points& points, core::TriangleMesh* hull) {
  std::vector<double> seconds;
  double sum = 0.0;
  while (sum < 0.3 || seconds.size() < 3) {
    const auto start = std::chrono::steady_clock::now();
    *hull = method.hull(points);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    seconds.push_back(passed.count());
    sum += seconds.back();
  }
  std::nth_element(seconds.begin(), seconds.begin() + seconds.size() / 2, seconds.end());
  return seconds[seconds.size() / 2];
}

// Returns the largest distance of a point outside of a face, in metres.
double LargestDistanceOutside(const core::TriangleMesh& hull, const Points& points) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / kProbes);
  double worst = 0.0;
  for (int t = 0; t < static_cast<int>(hull.triangles.size()); ++t) {
    const Vector3d area = core::TriangleAreaVector(hull, t);
    if (!(area.norm() > 0.0)) continue;
    const Vector3d normal = area.normalized();
    const double offset = normal.dot(hull.vertices[hull.triangles[t][0]]);
    for (std::size_t i = 0; i < points.size(); i += step) {
      worst = std::max(worst, normal.dot(points[i]) - offset);
    }
  }
  return worst;
}

void PrintRow(const PointSet& set, const Points& points, const Method& method,
              double exact_volume) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(p);
  core::TriangleMesh hull;
  try {
    const double seconds = MedianSeconds(method, points, &hull);
    const geometry::MeshValidity state = geometry::Examine(hull, 0);
    std::printf("%-7s %7zu %-6s %10.3f %8zu %9.1e %9.1e %-7s %6d\n", set.name, points.size(),
                method.name, 1e3 * seconds, hull.vertices.size(),
                LargestDistanceOutside(hull, points) / box.diagonal().norm(),
                geometry::SignedVolume(hull) / exact_volume - 1.0,
                state.closed && state.manifold ? "yes" : "NO", state.degenerate_triangles);
  } catch (const core::Error& error) {
    std::printf("%-7s %7zu %-6s failed: %s\n", set.name, points.size(), method.name, error.what());
  }
  std::fflush(stdout);
}

int Main(int argc, char** argv) {
  int largest = 100000;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string(argv[i]) == "--largest") largest = std::atoi(argv[i + 1]);
  }
  const PointSet sets[] = {{"ball", Ball}, {"sphere", OnSphere}, {"grid", Grid}, {"plate", Plate}};
  const Method methods[] = {{"ours", Ours}, {"qhull", Qhull}, {"CGAL", Cgal}};
  std::printf("%-7s %7s %-6s %10s %8s %9s %9s %-7s %6s\n", "set", "points", "method", "ms",
              "vertices", "outside", "volume", "closed", "slivers");
  for (const PointSet& set : sets) {
    for (int count = 100; count <= largest; count *= 10) {
      core::Rng rng = core::StreamRng(7, count);
      const Points points = set.make(count, rng);
      const double exact = geometry::SignedVolume(Cgal(points));
      for (const Method& method : methods) PrintRow(set, points, method, exact);
    }
  }
  return 0;
}

}  // namespace
}  // namespace simwright::bench

int main(int argc, char** argv) {
  try {
    return simwright::bench::Main(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
