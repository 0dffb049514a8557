#include "geometry/stable_poses.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/convex_hull.h"
#include "geometry/mass_properties.h"
#include "tests/geometry/solid_shapes.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;
using shapes::kPi;

std::vector<StablePose> Poses(const core::TriangleMesh& mesh) {
  return StablePoses(mesh, SolidMassProperties(mesh, 1.0).center_of_mass);
}

// Checks the invariants of a pose: the centre of mass over the origin, the body on z = 0.
void ExpectRests(const core::TriangleMesh& mesh, const StablePose& pose) {
  const Vector3d center = SolidMassProperties(mesh, 1.0).center_of_mass;
  core::TriangleMesh laid = mesh;
  core::Transform(Eigen::Affine3d(pose.resting_from_body.matrix()), &laid);
  EXPECT_NEAR(core::Bounds(laid).min().z(), 0.0, 1e-9);
  EXPECT_LT((pose.resting_from_body * center - Vector3d(0, 0, pose.center_height)).norm(), 1e-9);
  EXPECT_NEAR(pose.resting_from_body.linear().determinant(), 1.0, 1e-12);
  for (const Vector3d& corner : pose.support) {
    EXPECT_NEAR((pose.resting_from_body * corner).z(), 0.0, 1e-9);
  }
}

// Returns the solid angle of a rectangle a x b seen from height h above its centre.
double RectangleAngle(double a, double b, double h) {
  return 4.0 * std::asin(a * b / std::sqrt((a * a + 4 * h * h) * (b * b + 4 * h * h)));
}

TEST(StablePoses, BoxLiesOnSixFacesByTheirSolidAngles) {
  const core::TriangleMesh box = shapes::Box(1, 2, 3);
  const auto poses = Poses(box);
  ASSERT_EQ(poses.size(), 6u);
  const double expected[] = {RectangleAngle(2, 3, .5), RectangleAngle(1, 3, 1),
                             RectangleAngle(1, 2, 1.5)};
  const double height[] = {0.5, 1.0, 1.5};
  const double margin[] = {1.0, 0.5, 0.5};
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(poses[i].probability, expected[i / 2] / (4 * kPi), 1e-9);
    EXPECT_NEAR(poses[i].center_height, height[i / 2], 1e-12);
    EXPECT_NEAR(poses[i].margin, margin[i / 2], 1e-12);
    EXPECT_NEAR(poses[i].tipping_angle, std::atan2(margin[i / 2], height[i / 2]), 1e-12);
    EXPECT_EQ(poses[i].support.size(), 4u);
    ExpectRests(box, poses[i]);
    sum += poses[i].probability;
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(StablePoses, RegularTetrahedronHasFourEqual) {
  core::TriangleMesh mesh;
  mesh.vertices = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  const auto poses = Poses(mesh);
  ASSERT_EQ(poses.size(), 4u);
  for (const auto& pose : poses) {
    EXPECT_NEAR(pose.probability, 0.25, 1e-9);
    ExpectRests(mesh, pose);
  }
}

// A slender handle through a heavy head: it lies down, and does not stand on the handle's end.
TEST(StablePoses, HammerLies) {
  const core::TriangleMesh hammer =
      shapes::BoxUnion({shapes::BoxAt(-.01, -.01, 0, .01, .01, .3),
                        shapes::BoxAt(-.05, -.015, .26, .05, .015, .29)});
  const auto poses = Poses(hammer);
  ASSERT_GE(poses.size(), 2u);
  // On its side the head's flank and the handle's end support it.
  EXPECT_GT(std::abs(poses[0].face_normal.y()), 0.99);
  EXPECT_GT(poses[0].probability, 0.3);
  for (const auto& pose : poses) {
    ExpectRests(hammer, pose);
    EXPECT_GT(pose.margin, 0.0);
  }
  const Vector3d center = SolidMassProperties(hammer, 1.0).center_of_mass;
  EXPECT_NEAR(TippingAngle(hammer, center, -Vector3d::UnitZ(), 1e-6), std::atan2(0.01, center.z()),
              1e-9);
  EXPECT_GT(poses[0].tipping_angle, TippingAngle(hammer, center, -Vector3d::UnitZ(), 1e-6));
}

// Height 2 on radius 0.5: stands on its base with the solid angle of a disc seen from h/4.
TEST(StablePoses, ConeStandsOnItsBaseOrLies) {
  const core::TriangleMesh cone = shapes::Cone(0.5, 2.0, 64);
  const auto poses = Poses(cone);
  double base = 0.0;
  for (const auto& pose : poses) {
    if (pose.face_normal.z() < -0.99) base += pose.probability;
    ExpectRests(cone, pose);
  }
  EXPECT_NEAR(base, 0.5 * (1.0 - 0.5 / std::hypot(0.5, 0.5)), 2e-3);
  // The sides share the rest equally: a cone of half angle atan(1/4) is stable on each facet.
  EXPECT_EQ(poses.size(), 65u);
}

// A tall leaning prism that is unstable on its base: that share goes to the face that it falls
// onto.
TEST(StablePoses, UnstableFaceHandsItsShareOn) {
  core::TriangleMesh leaning = shapes::Box(1, 1, 3);
  for (Vector3d& v : leaning.vertices) v.x() += 0.8 * v.z();
  const auto poses = Poses(leaning);
  double sum = 0.0, falls = 0.0;
  for (const auto& pose : poses) {
    EXPECT_LT(std::abs(pose.face_normal.z()), 0.9);  // neither on its base nor on its top
    sum += pose.probability;
    if (pose.face_normal.x() > 0.5 || pose.face_normal.x() < -0.5) falls += pose.probability;
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_EQ(poses.size(), 4u);
  EXPECT_GT(falls, 0.5);
}

TEST(TippingAngle, NegativeWhereItDoesNotStand) {
  const core::TriangleMesh sphere = shapes::Sphere(1.0, 32);
  EXPECT_LE(TippingAngle(sphere, Vector3d::Zero(), Vector3d(1, 2, 3), 1e-9), 1e-9);
  const core::TriangleMesh box = shapes::Box(1, 1, 1);
  EXPECT_NEAR(TippingAngle(box, Vector3d(.5, .5, .5), {0, 0, -1}, 1e-9), kPi / 4, 1e-12);
  EXPECT_LT(TippingAngle(box, Vector3d(1.5, .5, .5), {0, 0, -1}, 1e-9), 0.0);
}

bool RollsThere(const core::TriangleMesh& mesh, const Vector3d& down) {
  return Rolls(mesh, SolidMassProperties(mesh, 1.0).center_of_mass, down);
}

TEST(Rolls, BallsLyingCylindersAndConesDo) {
  const Vector3d below = -Vector3d::UnitZ(), side = Vector3d::UnitX();
  EXPECT_TRUE(RollsThere(shapes::Sphere(1.0, 24), below));
  EXPECT_TRUE(RollsThere(shapes::Sphere(0.02, 48), Vector3d(1, 2, 3).normalized()));
  for (const int sides : {10, 32, 128}) {
    EXPECT_TRUE(RollsThere(shapes::Cylinder(0.03, 0.2, sides), side)) << sides;
    EXPECT_FALSE(RollsThere(shapes::Cylinder(0.03, 0.2, sides), below)) << sides;
  }
  core::TriangleMesh egg = shapes::Sphere(1.0, 32);
  for (Vector3d& v : egg.vertices) v.z() *= v.z() > 0.0 ? 1.5 : 1.2;
  EXPECT_TRUE(RollsThere(egg, side));
  const core::TriangleMesh cone = shapes::Cone(0.03, 0.15, 48);
  EXPECT_TRUE(RollsThere(cone, Vector3d(0.15, 0.0, 0.03).normalized()));
  EXPECT_FALSE(RollsThere(cone, below));
}

TEST(Rolls, WhatRocksStandsOrTipsDoesNot) {
  const Vector3d below = -Vector3d::UnitZ();
  EXPECT_FALSE(RollsThere(shapes::Box(1, 1, 1), below));                    // a die
  EXPECT_FALSE(RollsThere(shapes::Cylinder(1, 20, 6), Vector3d::UnitX()));  // a pencil
  EXPECT_FALSE(RollsThere(shapes::Cylinder(1, 40, 64), below));             // on its end: it falls
  EXPECT_FALSE(RollsThere(shapes::Cylinder(1, 0.1, 64), below));            // a coin
  EXPECT_FALSE(RollsThere(shapes::Bowl(1, 0.1, 32), below));   // rocks on its round side
  EXPECT_FALSE(RollsThere(shapes::Bowl(1, 0.1, 32), -below));  // on its rim
  EXPECT_FALSE(RollsThere(shapes::Torus(1, 0.3, 48, 16), below));
  EXPECT_TRUE(RollsThere(shapes::Torus(1, 0.3, 48, 16), Vector3d::UnitX()));  // as a wheel
  core::TriangleMesh pebble = shapes::Sphere(1.0, 32);
  for (Vector3d& v : pebble.vertices) v = v.cwiseProduct(Vector3d(3, 2, 1));
  EXPECT_FALSE(RollsThere(pebble, below));
  // Icosahedron: 20.9 degrees from a face to its edge.
  const double g = std::numbers::phi;
  core::TriangleMesh twenty;
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-g, g}) {
      twenty.vertices.insert(twenty.vertices.end(), {{0, s, t}, {s, t, 0}, {t, 0, s}});
    }
  }
  twenty = ConvexHull(twenty.vertices);
  for (int t = 0; t < 20; ++t) {
    EXPECT_FALSE(RollsThere(twenty, core::TriangleAreaVector(twenty, t).normalized()));
  }
}

TEST(StablePoses, RefusesBadInput) {
  const core::TriangleMesh box = shapes::Box(1, 1, 1);
  EXPECT_THROW(StablePoses(box, Vector3d(2, 0, 0)), core::Error);
  EXPECT_THROW(StablePoses(box, Vector3d(std::nan(""), 0, 0)), core::Error);
  EXPECT_THROW(StablePoses({}, Vector3d::Zero()), core::Error);
}

}  // namespace
}  // namespace simwright::geometry
