#include "geometry/hull_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/random.h"
#include "geometry/convex_hull.h"
#include "geometry/weld.h"
#include "tests/geometry/solid_shapes.h"

namespace simwright::geometry {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;
using Eigen::Vector4d;

// Returns the hull of the vertices on one side of a random plane.
TriangleMesh PartialHull(const TriangleMesh& solid, core::Rng& rng) {
  const Vector3d normal = core::UniformDirection(rng);
  const Eigen::AlignedBox3d box = core::Bounds(solid);
  const double offset =
      normal.dot(box.center()) + core::Uniform(rng, -0.2, 0.2) * box.sizes().maxCoeff();
  std::vector<Vector3d> points;
  for (const Vector3d& v : solid.vertices) {
    if (normal.dot(v) <= offset) points.push_back(v);
  }
  return points.size() < 8 ? ConvexHull(solid.vertices) : ThickenedConvexHull(points, 1e-3);
}

// Returns true if `p` is inside: the solid angle of the surface seen from it is 4 pi (van Oosterom
// and Strackee 1983).
bool SeesAllAround(const TriangleMesh& solid, const Vector3d& p) {
  double sum = 0.0;
  for (const auto& t : solid.triangles) {
    const Vector3d a = solid.vertices[t[0]] - p, b = solid.vertices[t[1]] - p,
                   c = solid.vertices[t[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum > 2.0 * shapes::kPi;
}

double DistanceTo(const TriangleMesh& solid, const Vector3d& p) {
  double least = INFINITY;
  for (const auto& t : solid.triangles) {
    const Vector3d on =
        ClosestPointOnTriangle(p, solid.vertices[t[0]], solid.vertices[t[1]], solid.vertices[t[2]]);
    least = std::min(least, (on - p).norm());
  }
  return least;
}

// Returns the largest distance of points at most `spacing` apart on the hull, outside the solid.
double FarthestOverhang(const TriangleMesh& solid, const TriangleMesh& hull, double spacing) {
  double farthest = 0.0;
  for (const auto& t : hull.triangles) {
    const Vector3d a = hull.vertices[t[0]], ab = hull.vertices[t[1]] - a,
                   ac = hull.vertices[t[2]] - a;
    const int n =
        1 + static_cast<int>(std::max({ab.norm(), ac.norm(), (ac - ab).norm()}) / spacing);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        const Vector3d p = a + (i + 1.0 / 3.0) / n * ab + (j + 1.0 / 3.0) / n * ac;
        const double distance = DistanceTo(solid, p);
        if (distance > farthest && !SeesAllAround(solid, p)) farthest = distance;
      }
    }
  }
  return farthest;
}

TEST(HullDeviation, DistanceIsThatOfBruteForce) {
  core::Rng rng(4);
  for (const TriangleMesh& solid :
       {shapes::Torus(1.0, 0.3, 16, 8), shapes::Torus(1.0, 0.1, 9, 6)}) {
    const HullDeviation fit(solid, 1000, 1);
    for (int i = 0; i < 6; ++i) {
      const TriangleMesh hull = PartialHull(solid, rng);
      const std::vector<Vector4d> planes = FacePlanes(hull);
      double buried = 0.0;
      for (const Vector3d& p : fit.samples()) {
        buried = std::max(buried, -MaxPlaneDistance(planes, p));
      }
      // A distance changes by no more than the way between two points.
      const double spacing = std::sqrt(core::SurfaceArea(hull) / 500.0), fine = 0.25 * spacing;
      const double expected = std::max(buried, FarthestOverhang(solid, hull, fine));
      EXPECT_LE(fit.Distance(hull), expected + fine);
      EXPECT_GE(fit.Distance(hull), expected - spacing);
      EXPECT_GE(fit.Distance(hull), buried);
    }
  }
}

// The search may stop early, above the limit; otherwise the limit does not matter.
TEST(HullDeviation, LimitsGiveBounds) {
  core::Rng rng(6);
  const TriangleMesh solid = shapes::Torus(1.0, 0.3, 24, 12);
  const HullDeviation fit(solid, 2000, 1);
  int above = 0;
  for (int i = 0; i < 40; ++i) {
    const TriangleMesh hull = PartialHull(solid, rng);
    const double volume = core::Uniform(rng, 0.5, 1.0) * SignedVolume(hull);
    const double exact = fit.Concavity(hull, volume, std::numeric_limits<double>::infinity());
    EXPECT_EQ(fit.Concavity(hull, volume, exact + 1e-5), exact);  // rounded to 1e-5
    EXPECT_EQ(fit.Concavity(hull, volume, 1.5 * exact), exact);
    for (const double share : {0.1, 0.5, 0.9, 0.99}) {
      const double bound = fit.Concavity(hull, volume, share * exact);
      EXPECT_GT(bound, share * exact);
      EXPECT_LE(bound, exact + 2e-5);
      above += bound < exact;
    }
  }
  EXPECT_GT(above, 10);
}

}  // namespace
}  // namespace simwright::geometry
