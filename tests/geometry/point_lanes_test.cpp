#include "geometry/point_lanes.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "core/random.h"
#include "geometry/convex_hull.h"
#include "geometry/hull_fit.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

// The references test one point after the other.
TEST(PointLanes, FourPointsAtOnceAreExactlyEach) {
  core::Rng rng(3);
  std::vector<Vector3d> corners;
  for (int i = 0; i < 30; ++i) corners.push_back(core::UniformDirection(rng));
  const core::TriangleMesh hull = ConvexHull(corners);
  const std::vector<Vector4d> planes = FacePlanes(hull);
  const Eigen::AlignedBox3d box = core::Bounds(hull);
  for (const int count : {0, 1, 2, 3, 4, 5, 18, 101}) {
    std::vector<Vector3d> points, inside;
    for (int i = 0; i < count; ++i) {
      points.emplace_back(core::Uniform(rng, -1.2, 1.2), core::Uniform(rng, -1.2, 1.2),
                          core::Uniform(rng, -1.2, 1.2));
      if (i % 5 == 0) points.back() = corners[i % 30];
      if (box.contains(points.back())) inside.push_back(points.back());
    }
    const PointLanes lanes(points);
    EXPECT_EQ(lanes.size(), count);
    const PointLanes within = lanes.Within(box);
    EXPECT_EQ(within.size(), static_cast<int>(inside.size()));

    const Vector3d normal = core::UniformDirection(rng);
    double support = -std::numeric_limits<double>::infinity(), deepest = 0.0;
    int below = 0;
    for (const Vector3d& p : points) {
      support = std::max(support, normal.dot(p));
      const double height = MaxPlaneDistance(planes, p);
      deepest = std::max(deepest, -height);
      below += height < 0.0;
    }
    EXPECT_EQ(lanes.Support(normal), support);
    EXPECT_EQ(lanes.CountBelow(planes), below);
    EXPECT_EQ(within.CountBelow(planes), below);
    EXPECT_EQ(lanes.Depth(planes, 2.0), deepest);
    double first = 0.0;  // deepest up to the first beyond the limit
    for (const Vector3d& p : inside) {
      first = std::max(first, -MaxPlaneDistance(planes, p));
      if (first > 0.3 * deepest) break;
    }
    EXPECT_EQ(within.Depth(planes, 0.3 * deepest), first);
  }
}

}  // namespace
}  // namespace simwright::geometry
