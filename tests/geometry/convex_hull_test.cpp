#include "geometry/convex_hull.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "geometry/exact_hull.h"
#include "geometry/mesh_validity.h"
#include "geometry/weld.h"
#include "tests/geometry/solid_shapes.h"
#include "tests/sanitized.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

// Returns the largest distance of a point outside of a face, relative to the diagonal.
double Outside(const core::TriangleMesh& hull, const std::vector<Vector3d>& points) {
  double worst = 0.0;
  for (int t = 0; t < static_cast<int>(hull.triangles.size()); ++t) {
    const Vector3d normal = core::TriangleAreaVector(hull, t).normalized();
    for (const Vector3d& p : points) {
      worst = std::max(worst, normal.dot(p - hull.vertices[hull.triangles[t][0]]));
    }
  }
  return worst / core::Bounds(hull).diagonal().norm();
}

void ExpectSound(const core::TriangleMesh& hull) {
  const MeshValidity s = Examine(hull);
  EXPECT_TRUE(s.IsSolid()) << Describe(s);
  EXPECT_EQ(hull.triangles.size(), 2 * hull.vertices.size() - 4);  // Euler
}

TEST(ConvexHull, CubeOfAFullGridHasEightCorners) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(i % 10, i / 10 % 10, i / 100);
  const core::TriangleMesh hull = ConvexHull(points);
  EXPECT_EQ(hull.vertices.size(), 8u);
  ExpectSound(hull);
  EXPECT_NEAR(SignedVolume(hull), 729.0, 1e-9);
}

TEST(ConvexHull, TetrahedronOfFourPoints) {
  const core::TriangleMesh hull = ConvexHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  ExpectSound(hull);
  EXPECT_NEAR(SignedVolume(hull), 1.0 / 6.0, 1e-15);
}

TEST(ConvexHull, PointsOnASphereAreAllCorners) {
  core::Rng rng(3);
  std::vector<Vector3d> points;
  for (int i = 0; i < 500; ++i) points.push_back(core::UniformDirection(rng));
  const core::TriangleMesh hull = ConvexHull(points);
  ExpectSound(hull);
  EXPECT_EQ(hull.vertices.size(), 500u);
  EXPECT_LT(Outside(hull, points), 1e-5);
}

// Grids, rings and sheets, clean and with noise from far below to far above the tolerance.
TEST(ConvexHull, HoldsEveryPointOfAwkwardSets) {
  for (int kind = 0; kind < 4; ++kind) {
    for (const double noise : {0.0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3}) {
      for (int seed = 0; seed < 12; ++seed) {
        core::Rng rng = core::StreamRng(seed, kind);
        std::vector<Vector3d> points;
        const int n = 12 + static_cast<int>(core::UniformIndex(rng, 300));
        for (int i = 0; i < n; ++i) {
          const double a = 2 * shapes::kPi * core::UniformIndex(rng, 64) / 64;
          const Vector3d grid(core::UniformIndex(rng, 6), core::UniformIndex(rng, 6),
                              core::UniformIndex(rng, 6));
          const Vector3d ring(std::cos(a), std::sin(a), grid.z());
          const Eigen::AngleAxisd turn(0.7, Vector3d(1, 2, 3).normalized());
          const Vector3d base[] = {grid, ring, turn * grid + Vector3d(5, 6, 7),
                                   ring.cwiseProduct(Vector3d(1, 1, 0.02))};
          points.push_back(base[kind] + noise * core::UniformDirection(rng));
        }
        const core::TriangleMesh hull = ConvexHull(points);
        const MeshValidity s = Examine(hull);
        EXPECT_TRUE(s.closed && s.oriented && s.signed_volume > 0.0)
            << kind << ' ' << noise << ' ' << seed << ' ' << Describe(s);
        EXPECT_EQ(s.degenerate_triangles, 0);
        EXPECT_LT(Outside(hull, points), 2e-3) << kind << ' ' << noise << ' ' << seed;
      }
    }
  }
}

TEST(ExactHull, AgreesWithOurs) {
  core::Rng rng(3);
  std::vector<Vector3d> points;
  for (int i = 0; i < 500; ++i) points.push_back(core::Uniform(rng) * core::UniformDirection(rng));
  const core::TriangleMesh exact = ExactHull(points, 0);
  ExpectSound(exact);
  EXPECT_LT(Outside(exact, points), 1e-15);
  EXPECT_NEAR(SignedVolume(exact), SignedVolume(ConvexHull(points)), 1e-9);
  EXPECT_EQ(ExactHull(points, 16).vertices.size(), 16u);
  EXPECT_TRUE(ExactHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 3, 0}}, 0).empty());
}

// A loaf: dense points on noisy flat surfaces joined by round edges.
TEST(ConvexHull, OfALoafIsNotCalledFlat) {
  SKIP_UNDER_SANITIZERS();
  for (int seed = 0; seed < 4; ++seed) {
    core::Rng rng = core::StreamRng(seed, 9);
    std::vector<Vector3d> points;
    for (int i = 0; i < 20000; ++i) {
      Vector3d p = core::UniformDirection(rng);
      for (int k = 0; k < 3; ++k) p[k] = std::copysign(std::pow(std::abs(p[k]), 0.2), p[k]);
      points.push_back(p.cwiseProduct(Vector3d(1.0, 0.4, 0.5)) +
                       1e-6 * core::Uniform(rng) * core::UniformDirection(rng));
    }
    const core::TriangleMesh hull = ConvexHull(points);
    EXPECT_GT(SignedVolume(hull), 0.8 * SignedVolume(ExactHull(points, 0)));
    EXPECT_LT(Outside(hull, points), 2e-3);
    EXPECT_LE(ConvexHull(points, 64).vertices.size(), 64u);
  }
}

TEST(ConvexHull, LimitedStaysCloseAndInside) {
  const core::TriangleMesh sphere = shapes::Sphere(1.0, 96);
  const core::TriangleMesh full = ConvexHull(sphere.vertices);
  const core::TriangleMesh limited = ConvexHull(sphere.vertices, 64);
  EXPECT_EQ(limited.vertices.size(), 64u);
  ExpectSound(limited);
  // The best 64 points on a sphere cut off 6.4% of it.
  EXPECT_GT(SignedVolume(limited), 0.89 * SignedVolume(full));
  EXPECT_LT(Outside(full, limited.vertices), 1e-9);
  EXPECT_LT(Outside(limited, sphere.vertices) * core::Bounds(limited).diagonal().norm(), 0.09);

  const core::TriangleMesh cylinder = shapes::Cylinder(1.0, 2.0, 256);
  const core::TriangleMesh drum = ConvexHull(cylinder.vertices, 64);
  EXPECT_LE(drum.vertices.size(), 64u);
  EXPECT_GT(SignedVolume(drum), 0.985 * SignedVolume(cylinder));
}

TEST(ConvexHull, RefusesWhatHasNoVolume) {
  EXPECT_THROW(ConvexHull({}), core::Error);
  EXPECT_THROW(ConvexHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), core::Error);
  EXPECT_THROW(ConvexHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), core::Error);
  EXPECT_THROW(ConvexHull({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}), core::Error);
  EXPECT_THROW(ConvexHull(std::vector<Vector3d>(10, Vector3d::Ones())), core::Error);
  EXPECT_THROW(ConvexHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}), core::Error);
  EXPECT_THROW(ConvexHull(shapes::Box(1, 1, 1).vertices, 3), core::Error);
}

TEST(ThickenedConvexHull, GivesFlatStraightAndSinglePointsAVolume) {
  const double t = 0.01;
  const core::TriangleMesh sheet =
      ThickenedConvexHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, t);
  ExpectSound(sheet);
  EXPECT_NEAR(SignedVolume(sheet), t, 1e-12);
  const core::TriangleMesh rod = ThickenedConvexHull({{0, 0, 0}, {1, 2, 2}}, t);
  ExpectSound(rod);
  EXPECT_NEAR(SignedVolume(rod), 3.0 * t * t, 1e-12);
  const core::TriangleMesh dot = ThickenedConvexHull({{4, 5, 6}}, t);
  ExpectSound(dot);
  EXPECT_NEAR(SignedVolume(dot), t * t * t, 1e-15);
  const core::TriangleMesh box = ThickenedConvexHull(shapes::Box(1, 2, 3).vertices, t);
  EXPECT_NEAR(SignedVolume(box), 6.0, 1e-12);
}

}  // namespace
}  // namespace simwright::geometry
