// The shapes that Bullet gets instead of meshes: capsules, and one floor contact per shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "geometry/mass_properties.h"
#include "sim/articulated_world.h"
#include "sim/capsule_folding.h"

namespace simwright::sim {
namespace {

using assets::UrdfGeometry;
using Eigen::Vector3d;

assets::UrdfShape Primitive(UrdfGeometry geometry, double radius, double length,
                            const Eigen::Isometry3d& pose) {
  assets::UrdfShape shape;
  shape.geometry = geometry;
  shape.radius = radius;
  shape.length = length;
  shape.link_from_primitive = pose;
  shape.mesh = geometry == UrdfGeometry::kSphere ? assets::SphereMesh(radius)
                                                 : assets::CylinderMesh(radius, length);
  core::Transform(Eigen::Affine3d(pose), &shape.mesh);
  return shape;
}

std::vector<assets::UrdfShape> CapsuleShapes(double radius, double length,
                                             const Eigen::Isometry3d& pose) {
  const Vector3d half(0, 0, 0.5 * length);
  return {Primitive(UrdfGeometry::kCylinder, radius, length, pose),
          Primitive(UrdfGeometry::kSphere, radius, 0, pose * Eigen::Translation3d(half)),
          Primitive(UrdfGeometry::kSphere, radius, 0, pose * Eigen::Translation3d(-half))};
}

RigidBody WithMass(RigidBody body, double mass) {
  geometry::MassProperties total;
  for (const core::TriangleMesh& part : body.parts) {
    const auto one = geometry::SolidMassProperties(part, 1.0);
    total = total.mass > 0.0 ? geometry::Combined(total, one) : one;
  }
  body.inertial = {mass, total.center_of_mass, total.inertia * (mass / total.mass)};
  body.friction = 0.5;
  return body;
}

TEST(CapsuleMesh, HasACapsulesVolume) {
  const double r = 0.06, l = 0.283, pi = std::numbers::pi;
  const core::TriangleMesh mesh = assets::CapsuleMesh(r, l, 96);
  // Closed: Euler's V - E + F = 2 with E = 3 F / 2.
  const auto faces = static_cast<int>(mesh.triangles.size());
  EXPECT_EQ(static_cast<int>(mesh.vertices.size()) - 3 * faces / 2 + faces, 2);
  const double exact = pi * r * r * l + 4.0 / 3.0 * pi * r * r * r;
  EXPECT_NEAR(geometry::SolidMassProperties(mesh, 1.0).mass, exact, 0.003 * exact);
  Vector3d low = mesh.vertices[0], high = low;
  for (const Vector3d& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  EXPECT_NEAR(high.z(), 0.5 * l + r, 1e-12);
  EXPECT_NEAR(low.z(), -0.5 * l - r, 1e-12);
}

TEST(CapsuleFolding, TakesACylinderWithSpheresAtItsEndsForOne) {
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(0.1, -0.2, 0.3) * Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized());
  std::vector<assets::UrdfShape> shapes = CapsuleShapes(0.05, 0.2, pose);
  std::swap(shapes[0], shapes[2]);  // in any order
  shapes.push_back(Primitive(UrdfGeometry::kSphere, 0.04, 0, pose));
  shapes.push_back(Primitive(UrdfGeometry::kCylinder, 0.03, 0.1, pose));
  RigidBody body;
  AddShapes(shapes, &body);
  ASSERT_EQ(body.parts.size(), 3u);
  ASSERT_EQ(body.capsules.size(), 3u);
  ASSERT_TRUE(body.capsules[0]);
  EXPECT_LT((body.capsules[0]->a - pose * Vector3d(0, 0, 0.1)).norm(), 1e-12);
  EXPECT_LT((body.capsules[0]->b - pose * Vector3d(0, 0, -0.1)).norm(), 1e-12);
  ASSERT_TRUE(body.capsules[1]);  // the sphere
  EXPECT_EQ(body.capsules[1]->a, body.capsules[1]->b);
  EXPECT_FALSE(body.capsules[2]);  // a cylinder alone stays a mesh
}

TEST(CapsuleFolding, LeavesSpheresOfAnotherSizeAlone) {
  std::vector<assets::UrdfShape> shapes = CapsuleShapes(0.05, 0.2, Eigen::Isometry3d::Identity());
  shapes[2].radius = 0.04;
  RigidBody body;
  AddShapes(shapes, &body);
  EXPECT_EQ(body.parts.size(), 3u);
}

double Settle(ArticulatedWorld* world, double seconds) {
  const double end = world->time() + seconds;
  while (world->time() < end) world->Step();
  double force = 0.0;
  for (const LinkContact& contact : world->Contacts()) force += contact.impulse;
  return force / world->time_step();
}

// A capsule rests at its radius, and the floor carries its weight.
TEST(FloorContact, ACapsuleLiesAtItsRadius) {
  RigidBody body;
  AddShapes(CapsuleShapes(0.05, 0.2, Eigen::Isometry3d::Identity()), &body);
  ArticulatedWorld world;
  const Eigen::Isometry3d lying =
      Eigen::Translation3d(0, 0, 0.06) * Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX());
  const int index = world.Add(WithMass(body, 0.7), lying);
  const double force = Settle(&world, 2.0);
  EXPECT_NEAR(world.LinkPose(index, 0).translation().z(), 0.05, 1e-4);
  EXPECT_NEAR(force, 0.7 * 9.81, 0.02 * 0.7 * 9.81);
}

// A ring of 24 blocks rests on four contacts, not on 24 times four, and does not move.
TEST(FloorContact, AThingOfManyPartsStandsOnFourPoints) {
  RigidBody ring;
  for (int i = 0; i < 24; ++i) {
    core::TriangleMesh part = assets::BoxMesh({0.004, 0.009, 0.1});
    core::Transform(Eigen::Affine3d(Eigen::AngleAxisd(i * M_PI / 12, Vector3d::UnitZ()) *
                                    Eigen::Translation3d(0.035, 0, 0.05)),
                    &part);
    ring.parts.push_back(part);
  }
  ArticulatedWorld world;
  const int index = world.Add(WithMass(ring, 0.2), Eigen::Isometry3d::Identity());
  const double force = Settle(&world, 1.0);
  EXPECT_LE(world.Contacts().size(), 4u);
  EXPECT_NEAR(force, 0.2 * 9.81, 0.02 * 0.2 * 9.81);
  const Eigen::Isometry3d before = world.LinkPose(index, 0);
  Settle(&world, 4.0);
  const Eigen::Isometry3d moved = before.inverse() * world.LinkPose(index, 0);
  EXPECT_LT(moved.translation().norm(), 1e-4);
  EXPECT_LT(Eigen::AngleAxisd(moved.linear()).angle(), 1e-3);
}

// Pushed sideways at its middle, a block slides once the push exceeds friction: mu m g.
TEST(FloorContact, SlidesAboveFrictionAndStandsBelow) {
  RigidBody block;
  block.parts = {assets::BoxMesh({0.1, 0.1, 0.04})};
  const double mass = 0.5, friction = 0.5 * mass * 9.81;
  for (const double share : {0.9, 1.2}) {
    ArticulatedWorld world;
    const int index =
        world.Add(WithMass(block, mass), Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.02)));
    Settle(&world, 0.5);
    const Vector3d start = world.LinkPose(index, 0).translation();
    for (int step = 0; step < 120; ++step) {
      world.PushRoot(index, Vector3d(share * friction, 0, 0));
      world.Step();
    }
    const double moved = world.LinkPose(index, 0).translation().x() - start.x();
    const double expected = 0.5 * (share - 1.0) * 0.5 * 9.81 * 0.25;  // a t^2 / 2, t = 0.5 s
    if (share < 1.0) {
      EXPECT_LT(std::abs(moved), 1e-3);
    } else {
      EXPECT_NEAR(moved, expected, 0.1 * expected);
    }
  }
}

TEST(ArticulatedWorld, SharedShapesGiveTheSameWorldEachWithItsMass) {
  RigidBody block;
  block.parts = {assets::BoxMesh({0.1, 0.1, 0.04})};
  const auto prepared = std::make_shared<PreparedBody>(ArticulatedBodyFrom(WithMass(block, 0.5)));
  ArticulatedWorld world;
  Placement heavy;
  heavy.mass_scale = 3.0;
  heavy.fixed = false;
  const int index = world.Add(prepared, heavy);
  EXPECT_NEAR(world.LoadedInertial(index, 0).mass, 1.5, 1e-12);
  EXPECT_TRUE(world.LoadedInertial(index, 0).inertia.isApprox(
      3.0 * prepared->body().links[0].inertial.inertia, 1e-9));
  EXPECT_THROW(world.SetIterations(0), core::Error);
}

}  // namespace
}  // namespace simwright::sim
