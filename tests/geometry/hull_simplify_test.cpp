#include "geometry/hull_simplify.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "geometry/convex_decomposition.h"
#include "geometry/convex_hull.h"
#include "geometry/convex_hull_2d.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_validity.h"
#include "geometry/weld.h"
#include "tests/geometry/solid_shapes.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using shapes::kPi;

// Returns the area of the downward face at height z.
double FaceArea(const core::TriangleMesh& mesh, double z) {
  std::vector<Vector2d> points;
  for (const Vector3d& v : mesh.vertices) {
    if (std::abs(v.z() - z) < 1e-9) points.emplace_back(v.x(), v.y());
  }
  const std::vector<Vector2d> outline = ConvexHull2d(points);
  double area = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return area;
}

struct Simplified {
  core::TriangleMesh full, simple;
  MassProperties mass;
};

// Expects a valid hull within the limit, with the same volume and centre.
Simplified ExpectStandsFor(const core::TriangleMesh& shape, int most, double volume,
                           double center_share) {
  Simplified s;
  s.full = ConvexHull(shape.vertices);
  s.simple = SimplifyHull(s.full, most);
  EXPECT_LE(s.simple.vertices.size(), static_cast<std::size_t>(most));
  const MeshValidity sound = Examine(s.simple);
  EXPECT_TRUE(sound.closed && sound.oriented) << Describe(sound);
  s.mass = SolidMassProperties(s.simple, 1.0);
  EXPECT_NEAR(s.mass.volume / volume, 1.0, 0.01);
  const Vector3d center = SolidMassProperties(s.full, 1.0).center_of_mass;
  EXPECT_LT((s.mass.center_of_mass - center).norm(),
            center_share * core::Bounds(s.full).diagonal().norm());
  return s;
}

double PolygonArea(double radius, int corners) {
  return 0.5 * corners * radius * radius * std::sin(2.0 * kPi / corners);
}

TEST(SimplifyHull, CylindersAndDiscsKeepVolumeFootAndRoundness) {
  for (const int most : {64, 56, 52}) {
    for (const int n : {8, 24, 31, 32, 33, 40, 48, 64, 65, 97, 128, 200, 256}) {
      for (const double height : {2e-3, 0.02, 0.1, 1.0}) {
        SCOPED_TRACE(std::to_string(n) + " sides, height " + std::to_string(height));
        const double area = PolygonArea(0.05, n);
        const Simplified s =
            ExpectStandsFor(shapes::Cylinder(0.05, height, n), most, area * height, 1e-6);
        EXPECT_NEAR(FaceArea(s.simple, 0.0) / area, 1.0, 0.01);
        EXPECT_NEAR(FaceArea(s.simple, height) / area, 1.0, 0.01);
        EXPECT_NEAR(core::Bounds(s.simple).sizes().z(), height, 1e-12);
        // Still round: both moments perpendicular to the axis are equal.
        EXPECT_NEAR(s.mass.inertia(0, 0) / s.mass.inertia(1, 1), 1.0, 1e-6);
      }
    }
  }
}

TEST(SimplifyHull, SubdivisionAndPlaceChangeNothing) {
  for (const int n : {24, 32, 48, 64}) {
    core::TriangleMesh can = shapes::Cylinder(0.03, 0.1, n);
    const double volume = PolygonArea(0.03, n) * 0.1;
    for (int levels = 0; levels < 3; ++levels) {
      ExpectStandsFor(can, 56, volume, 1e-6);
      core::TriangleMesh lying = can;
      Eigen::Affine3d turn = Eigen::Affine3d::Identity();
      turn.rotate(Eigen::AngleAxisd(1.1, Vector3d(1, 2, -0.5).normalized()));
      turn.pretranslate(Vector3d(3, -2, 1));
      core::Transform(turn, &lying);
      ExpectStandsFor(lying, 56, volume, 1e-6);
      can = shapes::Subdivided(can);
    }
  }
}

TEST(SimplifyHull, ConesAndFrustums) {
  for (const int n : {33, 64, 100, 256}) {
    for (const double height : {0.02, 0.1, 0.5}) {
      const double base = PolygonArea(0.05, n), top = PolygonArea(0.02, n);
      const Simplified cone =
          ExpectStandsFor(shapes::Cone(0.05, height, n), 56, base * height / 3.0, 1e-3);
      EXPECT_NEAR(FaceArea(cone.simple, 0.0) / base, 1.0, 0.01);
      const core::TriangleMesh frustum =
          shapes::Revolved({{0.0, 0.0}, {0.05, 0.0}, {0.02, height}, {0.0, height}}, n);
      const Simplified cut =
          ExpectStandsFor(frustum, 56, height / 3.0 * (base + top + std::sqrt(base * top)), 1e-3);
      EXPECT_NEAR(FaceArea(cut.simple, 0.0) / base, 1.0, 0.01);
      EXPECT_NEAR(FaceArea(cut.simple, height) / top, 1.0, 0.01);
    }
  }
}

// Polyhedra of a few hundred faces are 1 to 4 % smaller than the ball that they approximate.
TEST(SimplifyHull, BallsAndEllipsoids) {
  for (const Vector3d& radii : {Vector3d(1, 1, 1), Vector3d(1, 1, 1.4), Vector3d(3, 2, 1)}) {
    for (core::TriangleMesh ball :
         {shapes::Icosphere(2), shapes::Icosphere(3), shapes::Icosphere(4), shapes::Sphere(1.0, 24),
          shapes::Sphere(1.0, 48)}) {
      for (Vector3d& v : ball.vertices) v = v.cwiseProduct(radii);
      for (const int most : {64, 56, 52}) {
        const Simplified s = ExpectStandsFor(ball, most, SignedVolume(ball), 2e-3);
        // Compares with the closed form's moments, (b^2 + c^2) / 5 etc., up to the faceting error.
        for (int k = 0; k < 3; ++k) {
          const double b = radii[(k + 1) % 3], c = radii[(k + 2) % 3];
          EXPECT_NEAR(s.mass.inertia(k, k) / s.mass.mass / ((b * b + c * c) / 5.0), 1.0, 0.06);
        }
        for (const Vector3d& v : s.simple.vertices) {
          EXPECT_NEAR(v.cwiseQuotient(radii).norm(), 1.0, 0.08);
        }
      }
    }
  }
}

TEST(SimplifyHull, CapsulesBowlsAndRings) {
  std::vector<Vector2d> capsule;
  for (int i = 0; i <= 8; ++i) {
    const double a = -kPi / 2 + kPi / 2 * i / 8;
    capsule.emplace_back(i == 0 ? 0.0 : std::cos(a), std::sin(a));
  }
  for (int i = 0; i <= 8; ++i) {
    const double a = kPi / 2 * i / 8;
    capsule.emplace_back(i == 8 ? 0.0 : std::cos(a), 2.0 + std::sin(a));
  }
  for (const core::TriangleMesh& shape :
       {shapes::Revolved(capsule, 32), shapes::Revolved(capsule, 48), shapes::Bowl(1, 0.1, 32),
        shapes::Bowl(1, 0.1, 48), shapes::Torus(1.0, 0.3, 48, 16), shapes::Torus(1, 0.1, 64, 24)}) {
    const core::TriangleMesh hull = ConvexHull(shape.vertices);
    const Simplified s = ExpectStandsFor(shape, 56, SignedVolume(hull), 5e-3);
    EXPECT_NEAR(core::Bounds(s.simple).sizes().z(), core::Bounds(hull).sizes().z(),
                1e-4 * core::Bounds(hull).sizes().z());
    EXPECT_NEAR(s.mass.inertia(0, 0) / s.mass.inertia(1, 1), 1.0, 1e-6);
    // The rim on which an inverted bowl rests, and the ring's flat ends.
    const double top = core::Bounds(hull).max().z();
    if (FaceArea(hull, top) > 0.5) {
      EXPECT_NEAR(FaceArea(s.simple, top) / FaceArea(hull, top), 1.0, 0.02);
    }
  }
}

TEST(SimplifyHull, EllipticAndHalfCylinders) {
  core::TriangleMesh tin = shapes::Cylinder(0.05, 0.1, 96);
  for (Vector3d& v : tin.vertices) v.x() *= 2.0;
  const double volume = 2.0 * PolygonArea(0.05, 96) * 0.1;
  const Simplified s = ExpectStandsFor(tin, 56, volume, 1e-6);
  EXPECT_NEAR(FaceArea(s.simple, 0.0) / (volume / 0.1), 1.0, 0.01);
  core::TriangleMesh half;
  for (const Vector3d& v : shapes::Cylinder(0.05, 0.1, 128).vertices) {
    if (v.y() > -1e-9) half.vertices.push_back(v);
  }
  const double half_volume = 0.5 * PolygonArea(0.05, 128) * 0.1;
  const Simplified h = ExpectStandsFor(half, 56, half_volume, 5e-3);
  EXPECT_NEAR(FaceArea(h.simple, 0.0) / (half_volume / 0.1), 1.0, 0.01);
}

// A box with rounded edges: six flat sides, three mirror planes.
TEST(SimplifyHull, RoundedBoxKeepsItsSidesAndItsMirrors) {
  const core::TriangleMesh ball = shapes::Icosphere(3);
  std::vector<Vector3d> points;
  for (const Vector3d& v : ball.vertices) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      if ((v.cwiseProduct(sign)).minCoeff() < -1e-9) continue;
      points.push_back(0.01 * v + Vector3d(0.04, 0.03, 0.02).cwiseProduct(sign));
    }
  }
  const core::TriangleMesh hull = ConvexHull(points);
  ASSERT_GT(hull.vertices.size(), 64u);
  const Simplified s = ExpectStandsFor(hull, 56, SignedVolume(hull), 1e-4);
  EXPECT_NEAR(core::Bounds(s.simple).sizes().z(), 0.06, 1e-9);
  EXPECT_NEAR(FaceArea(s.simple, -0.03) / (0.08 * 0.06), 1.0, 0.05);
  EXPECT_LT(std::abs(s.mass.inertia(0, 1)) + std::abs(s.mass.inertia(0, 2)) +
                std::abs(s.mass.inertia(1, 2)),
            1e-6 * s.mass.inertia.norm());
}

// An asymmetric hull.
TEST(SimplifyHull, UnevenHullsKeepTheirVolume) {
  core::Rng rng(7);
  for (int shape = 0; shape < 6; ++shape) {
    std::vector<Vector3d> points;
    for (int i = 0; i < 600; ++i) {
      const Vector3d d = core::UniformDirection(rng);
      points.push_back(d.cwiseProduct(Vector3d(1.0, 0.8, 0.5)) * (1.0 + 0.05 * core::Uniform(rng)) +
                       (d.x() > 0.0 ? Vector3d(0.4, 0.1, 0.0) : Vector3d(0.0, 0.0, 0.0)));
    }
    for (Vector3d& p : points) p.z() = std::max(p.z(), -0.3);  // it stands on a flat side
    const core::TriangleMesh hull = ConvexHull(points);
    const Simplified s = ExpectStandsFor(hull, 56, SignedVolume(hull), 5e-3);
    EXPECT_NEAR(FaceArea(s.simple, -0.3) / FaceArea(hull, -0.3), 1.0, 0.05);
    EXPECT_NEAR(core::Bounds(s.simple).min().z(), -0.3, 1e-9);
  }
}

TEST(SimplifyHull, WhatFitsStaysAndLimitsAreChecked) {
  const core::TriangleMesh box = shapes::Box(1, 2, 3);
  EXPECT_EQ(SimplifyHull(box, 64).vertices, box.vertices);
  EXPECT_THROW(SimplifyHull(box, 15), core::Error);
}

// The whole decomposition gives one part that has the solid's support.
TEST(Decompose, RoundSolidsBecomeOnePartOfTheirVolume) {
  for (const int n : {33, 64, 128, 256}) {
    for (const core::TriangleMesh& solid :
         {shapes::Cylinder(0.03, 0.1, n), shapes::Cylinder(0.05, 0.003, n),
          shapes::Cone(0.04, 0.1, n)}) {
      const ConvexDecomposition d = Decompose(solid);
      ASSERT_EQ(d.parts.size(), 1u);
      EXPECT_NEAR(SignedVolume(d.parts[0].hull) / SignedVolume(solid), 1.0, 0.01);
      EXPECT_NEAR(
          FaceArea(d.parts[0].hull, core::Bounds(d.parts[0].hull).min().z()) / FaceArea(solid, 0.0),
          1.0, 0.01);
      EXPECT_NEAR(core::Bounds(d.parts[0].hull).min().z(), 0.0, 1e-9);
    }
  }
}

}  // namespace
}  // namespace simwright::geometry
