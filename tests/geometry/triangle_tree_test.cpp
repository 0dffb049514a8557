#include "geometry/triangle_tree.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "core/random.h"

namespace simwright::geometry {
namespace {

using core::TriangleMesh;
using Eigen::Vector3d;

// Returns triangles of all sizes, with needles, points, repeated triangles and shared corners.
TriangleMesh Soup(int count, std::uint64_t seed) {
  core::Rng rng(seed);
  TriangleMesh soup;
  for (int t = 0; t < count; ++t) {
    const Vector3d center = 2.0 * core::UniformDirection(rng);
    const double size = std::pow(10.0, core::Uniform(rng, -3.0, 0.0));
    Vector3d corner[3];
    for (Vector3d& c : corner) c = center + size * core::UniformDirection(rng);
    if (t % 7 == 1) corner[2] = 0.5 * (corner[0] + corner[1]);
    if (t % 11 == 1) corner[1] = corner[2] = corner[0];
    const int first = static_cast<int>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), corner, corner + 3);
    if (t % 5 == 4) {
      soup.triangles.push_back(soup.triangles[t / 2]);
    } else {
      soup.triangles.emplace_back(first, first + 1,
                                  t % 3 == 2 ? soup.triangles[t - 1][0] : first + 2);
    }
  }
  return soup;
}

struct Nearest {
  int triangle = -1;
  double distance = INFINITY;
};

Nearest BruteForce(const TriangleMesh& mesh, const Vector3d& p) {
  Nearest best;
  double least = INFINITY;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    const Vector3d on =
        ClosestPointOnTriangle(p, mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]);
    const double squared = (on - p).squaredNorm();
    if (squared < least) {
      least = squared;
      best = {static_cast<int>(t), std::sqrt(squared)};
    }
  }
  return best;
}

// Four triangles at once have the rounding and the ties of one.
TEST(TriangleTree, ClosestIsExactlyBruteForce) {
  for (const int count : {1, 3, 4, 5, 17, 63, 400}) {
    const TriangleMesh soup = Soup(count, 3 + count);
    const TriangleTree tree(soup);
    EXPECT_EQ(tree.size(), count);
    core::Rng rng(5);
    int home = -1;
    for (int q = 0; q < 400; ++q) {
      Vector3d p = 3.0 * core::Uniform(rng) * core::UniformDirection(rng);
      // Corners are equally far from all triangles that share them.
      if (q % 4 == 0) p = soup.vertices[q % soup.vertices.size()];
      const Nearest expected = BruteForce(soup, p);
      const SurfacePoint found = tree.Closest(p);
      EXPECT_EQ(found.triangle, expected.triangle);
      EXPECT_EQ(found.distance, expected.distance);
      const double reach = expected.distance * core::Uniform(rng, 0.5, 1.5);
      EXPECT_EQ(tree.Within(p, reach), expected.distance <= reach);
      EXPECT_EQ(tree.Within(p, reach, &home), expected.distance <= reach);
    }
  }
}

TEST(TriangleTree, FirstHitSolvesEachTriangleAndOverlapsAreComplete) {
  const TriangleMesh soup = Soup(150, 8);
  const TriangleTree tree(soup);
  core::Rng rng(9);
  for (int q = 0; q < 300; ++q) {
    const Vector3d p = 2.5 * core::Uniform(rng) * core::UniformDirection(rng);
    // Along an axis, two of the direction's coordinates vanish.
    const Vector3d direction =
        q % 3 == 0 ? Vector3d(Vector3d::Unit(q % 9 / 3)) : core::UniformDirection(rng);
    Nearest first;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      const Vector3d &a = soup.vertices[soup.triangles[t][0]],
                     &b = soup.vertices[soup.triangles[t][1]],
                     &c = soup.vertices[soup.triangles[t][2]];
      // p + x direction = a + y (b - a) + z (c - a)
      Eigen::Matrix3d columns;
      columns << -direction, b - a, c - a;
      const Eigen::FullPivLU<Eigen::Matrix3d> system(columns);
      if (!system.isInvertible()) continue;  // a triangle without area, or along the ray
      const Vector3d x = system.solve(p - a);
      const bool hits = x.minCoeff() >= 0.0 && x[1] + x[2] <= 1.0;
      if (hits && x[0] < first.distance) first = {static_cast<int>(t), x[0]};
    }
    const auto hit = tree.FirstHit(p, direction);
    ASSERT_EQ(hit.has_value(), first.triangle >= 0);
    if (hit.has_value()) {
      EXPECT_EQ(hit->triangle, first.triangle);
      EXPECT_NEAR(hit->distance, first.distance, 1e-9 * (1.0 + first.distance));
      EXPECT_FALSE(tree.FirstHit(p, direction, 0.999 * first.distance).has_value());
    }
    const Eigen::AlignedBox3d box(p, Vector3d(p + 0.3 * Vector3d::Ones()));
    std::vector<int> found, expected;
    tree.Overlapping(box, &found);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      Eigen::AlignedBox3d around;
      for (int k = 0; k < 3; ++k) around.extend(soup.vertices[soup.triangles[t][k]]);
      if (around.intersects(box)) expected.push_back(static_cast<int>(t));
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(TriangleTree, NothingIsNearAnEmptyMesh) {
  const TriangleTree tree((TriangleMesh()));
  EXPECT_EQ(tree.Closest(Vector3d::Zero()).triangle, -1);
  EXPECT_FALSE(tree.Within(Vector3d::Zero(), 1e9));
  EXPECT_FALSE(tree.FirstHit(Vector3d::Zero(), Vector3d::UnitX()).has_value());
}

}  // namespace
}  // namespace simwright::geometry
