#include "geometry/surface_distance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "geometry/triangle_tree.h"

namespace simwright::geometry {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;

TriangleMesh Box(double half) {
  TriangleMesh mesh;
  for (int c = 0; c < 8; ++c) {
    mesh.vertices.emplace_back(c & 1 ? half : -half, c & 2 ? half : -half, c & 4 ? half : -half);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(SurfaceDistance, OffsetBoxesLieTheirOffsetApart) {
  const SurfaceDistance d = OuterSurfaceDistance(Box(1.0), Box(1.1));
  EXPECT_NEAR(d.diagonal, 2.0 * std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(d.visual_to_solid_max, 0.1, 1e-9);
  EXPECT_NEAR(d.visual_to_solid_p99, 0.1, 1e-9);
  // The larger box's corners are sqrt(3) * 0.1 away; samples come near them.
  EXPECT_GT(d.solid_to_visual_max, 0.15);
  EXPECT_LE(d.solid_to_visual_max, 0.1 * std::sqrt(3.0) + 1e-12);
  EXPECT_DOUBLE_EQ(d.MaxRatio(), d.solid_to_visual_max / d.diagonal);
}

// Inner surfaces are not hit from outside, but are part of the visual mesh all the same.
TEST(SurfaceDistance, InnerShellsAreNotSeen) {
  TriangleMesh nested = Box(1.0);
  core::Append(Box(0.5), &nested);
  EXPECT_NEAR(OuterSurfaceDistance(nested, Box(1.0)).visual_to_solid_max, 0.0, 1e-12);
  EXPECT_NEAR(OuterSurfaceDistance(Box(1.0), nested).solid_to_visual_max, 0.5, 0.001);
  for (const Vector3d& p : SampleOuterSurface(nested, 2000, 3)) {
    EXPECT_NEAR(p.cwiseAbs().maxCoeff(), 1.0, 1e-9);
  }
}

TEST(SurfaceDistance, ThreadsDoNotMatterAndBadInputIsRefused) {
  core::SetThreadCount(1);
  const SurfaceDistance one = OuterSurfaceDistance(Box(1.0), Box(1.07));
  core::SetThreadCount(4);
  const SurfaceDistance four = OuterSurfaceDistance(Box(1.0), Box(1.07));
  core::SetThreadCount(0);
  EXPECT_EQ(one.solid_to_visual_max, four.solid_to_visual_max);
  EXPECT_EQ(one.outer_points, four.outer_points);
  EXPECT_THROW(OuterSurfaceDistance({}, Box(1.0)), core::Error);
  EXPECT_THROW(SampleSurface({}, 10, 1), core::Error);
}

// The reference tests every triangle.
TEST(TriangleTree, AgreesWithBruteForce) {
  core::Rng rng(2);
  TriangleMesh soup;
  for (int t = 0; t < 300; ++t) {
    const Vector3d center = 2.0 * core::UniformDirection(rng);
    for (int c = 0; c < 3; ++c) {
      soup.vertices.push_back(center + 0.4 * core::UniformDirection(rng));
    }
    soup.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
  }
  const TriangleTree tree(soup);
  for (int q = 0; q < 300; ++q) {
    const Vector3d p = 3.0 * core::Uniform(rng) * core::UniformDirection(rng);
    double least = INFINITY;
    for (int t = 0; t < 300; ++t) {
      const Vector3d on = ClosestPointOnTriangle(p, soup.vertices[3 * t], soup.vertices[3 * t + 1],
                                                 soup.vertices[3 * t + 2]);
      least = std::min(least, (on - p).norm());
    }
    const SurfacePoint found = tree.Closest(p);
    EXPECT_NEAR(found.distance, least, 1e-12);
    EXPECT_NEAR((found.point - p).norm(), least, 1e-12);
    EXPECT_EQ(tree.Closest(p, 0.5 * least).triangle, -1);
    EXPECT_FALSE(tree.Within(p, (1.0 - 1e-9) * least));
    EXPECT_TRUE(tree.Within(p, (1.0 + 1e-9) * least));

    const Vector3d direction = core::UniformDirection(rng);
    double first = INFINITY;
    for (int t = 0; t < 300; ++t) {
      TriangleMesh single;
      single.vertices = {soup.vertices[3 * t], soup.vertices[3 * t + 1], soup.vertices[3 * t + 2]};
      single.triangles = {{0, 1, 2}};
      if (const auto hit = TriangleTree(single).FirstHit(p, direction)) {
        first = std::min(first, hit->distance);
      }
    }
    const auto hit = tree.FirstHit(p, direction);
    EXPECT_EQ(hit.has_value(), std::isfinite(first));
    if (hit.has_value()) {
      EXPECT_NEAR(hit->distance, first, 1e-12);
    }
  }
}

TEST(TriangleTree, ClosestPointsOnOneTriangle) {
  const Vector3d a(0, 0, 0), b(4, 0, 0), c(0, 3, 0);
  EXPECT_EQ(ClosestPointOnTriangle({-1, -1, 2}, a, b, c), a);
  EXPECT_EQ(ClosestPointOnTriangle({6, -1, 0}, a, b, c), b);
  EXPECT_EQ(ClosestPointOnTriangle({1, 1, 5}, a, b, c), Vector3d(1, 1, 0));
  EXPECT_EQ(ClosestPointOnTriangle({2, -3, 0}, a, b, c), Vector3d(2, 0, 0));
  // From the slanted side, 3 x + 4 y = 12: the projection of (3.5, 3.5) is (3.5, 3.5) - 12.5 (3, 4)
  // / 25.
  EXPECT_TRUE(ClosestPointOnTriangle({3.5, 3.5, 0}, a, b, c).isApprox(Vector3d(2, 1.5, 0), 1e-12));
}

}  // namespace
}  // namespace simwright::geometry
