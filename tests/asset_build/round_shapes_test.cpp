// Round and faceted shapes through the whole build of an asset and its check on disk in both
// engines: standing bodies keep their whole support polygon, rolling ones are graded as such, and
// real faults fail.
#include <cmath>

#include <gtest/gtest.h>

#include "asset_build/asset_builder.h"
#include "assets/asset_folder.h"
#include "core/files.h"
#include "geometry/convex_hull.h"
#include "geometry/stable_poses.h"
#include "geometry/weld.h"
#include "tests/geometry/solid_shapes.h"
#include "validation/check.h"

namespace simwright::asset_build {
namespace {

using Eigen::Vector3d;

assets::Asset Built(const core::TriangleMesh& mesh, const std::string& category) {
  core::TexturedMesh visual;
  visual.mesh = mesh;
  BuildRequest request;
  request.name = "shape";
  request.source = "shape.obj";
  request.category = physics_params::RequireCategory(category);
  core::Progress silent;
  return BuildAsset(visual, request, &silent).asset;
}

validation::CheckReport Checked(const assets::Asset& asset) {
  const core::TemporaryFolder folder;
  assets::WriteAsset(asset, folder.path());
  return validation::CheckAsset(folder.path());
}

const core::Finding* RowOf(const validation::CheckReport& report, const std::string& code) {
  for (const core::Finding& row : report.results) {
    if (row.code == code) return &row;
  }
  return nullptr;
}

core::TriangleMesh Scaled(core::TriangleMesh mesh, const Vector3d& by) {
  for (Vector3d& v : mesh.vertices) v = v.cwiseProduct(by);
  return mesh;
}

core::TriangleMesh RoundShapesTurned(core::TriangleMesh mesh, double angle, const Vector3d& axis) {
  core::Transform(Eigen::Affine3d(Eigen::AngleAxisd(angle, axis)), &mesh);
  return mesh;
}

// Checks that a one-part asset stands in its given pose and tolerates the tilt that its solid does.
void ExpectStands(const core::TriangleMesh& mesh, const std::string& category) {
  const assets::Asset asset = Built(mesh, category);
  const validation::CheckReport report = Checked(asset);
  EXPECT_EQ(report.grade(), validation::Grade::kPass) << validation::CheckTable(report);
  EXPECT_FALSE(asset.rolls);
  EXPECT_LT(asset.link_from_input.linear().col(2).head<2>().norm(), 1e-6) << "it fell over";
  ASSERT_EQ(asset.parts.size(), 1u);
  EXPECT_NEAR(geometry::SignedVolume(asset.parts[0]) / geometry::SignedVolume(asset.solid), 1.0,
              0.01);
  const Vector3d down = -Vector3d::UnitZ(), center = asset.inertial.center_of_mass;
  EXPECT_NEAR(geometry::TippingAngle(asset.parts[0], center, down, 1e-7) /
                  geometry::TippingAngle(asset.solid, center, down, 1e-7),
              1.0, 0.02);
}

void ExpectRolls(const core::TriangleMesh& mesh, const std::string& category) {
  SCOPED_TRACE(category);
  const assets::Asset asset = Built(mesh, category);
  const validation::CheckReport report = Checked(asset);
  EXPECT_NE(report.grade(), validation::Grade::kFail) << validation::CheckTable(report);
  EXPECT_TRUE(asset.rolls);
  ASSERT_NE(RowOf(report, "rolls-bullet"), nullptr);
  ASSERT_NE(RowOf(report, "rolls-mujoco"), nullptr);
  EXPECT_EQ(RowOf(report, "settles-bullet"), nullptr);
}

TEST(RoundShapes, CansOfAnyNumberOfSidesStand) {
  for (const int sides : {8, 24, 32, 33, 41, 48, 64, 100, 256}) {
    SCOPED_TRACE(std::to_string(sides) + " sides");
    ExpectStands(shapes::Cylinder(0.03, 0.1, sides), "candle");
  }
}

TEST(RoundShapes, SubdividedCansStand) {
  for (const int sides : {24, 48, 64}) {
    core::TriangleMesh can = shapes::Cylinder(0.03, 0.1, sides);
    for (int levels = 1; levels <= 2; ++levels) {
      can = shapes::Subdivided(can);
      SCOPED_TRACE(std::to_string(sides) + " sides, in four " + std::to_string(levels) + " times");
      ExpectStands(can, "candle");
    }
  }
}

TEST(RoundShapes, CoinsPlatesAndConesStand) {
  for (const int sides : {5, 6, 8, 10, 12, 15, 20}) {
    SCOPED_TRACE(std::to_string(sides) + " sides");
    ExpectStands(shapes::Cylinder(0.05, 0.003, sides), "object");
    ExpectStands(shapes::Cylinder(0.01, 0.008, sides), "object");  // a nut
  }
  ExpectStands(shapes::Cylinder(0.012, 0.002, 64), "object");
  ExpectStands(shapes::Cylinder(0.05, 0.003, 128), "object");
  ExpectStands(shapes::Cylinder(0.12, 0.01, 96), "object");
  ExpectStands(shapes::Cone(0.05, 0.12, 48), "object");
  ExpectStands(shapes::Cone(0.05, 0.12, 96), "object");
  ExpectStands(shapes::Revolved({{0.0, 0.0}, {0.05, 0.0}, {0.03, 0.08}, {0.0, 0.08}}, 72),
               "object");
}

TEST(RoundShapes, BallsEggsAndLyingCylindersRoll) {
  for (const int levels : {1, 2, 3}) {
    SCOPED_TRACE(std::to_string(levels));
    ExpectRolls(Scaled(shapes::Icosphere(levels), Vector3d::Constant(0.035)), "tomato");
  }
  ExpectRolls(shapes::Sphere(0.035, 32), "tomato");
  ExpectRolls(Scaled(shapes::Sphere(1.0, 32), Vector3d(0.03, 0.022, 0.022)), "egg");
  const double quarter = shapes::kPi / 2;
  ExpectRolls(RoundShapesTurned(shapes::Cylinder(0.03, 0.2, 48), quarter, Vector3d::UnitX()),
              "bottle");
  ExpectRolls(RoundShapesTurned(shapes::Cylinder(0.004, 0.15, 32), quarter, Vector3d::UnitY()),
              "pen");
}

// None of these may be refused.
TEST(RoundShapes, DiceRingsAndBowlsRest) {
  const std::vector<std::pair<std::string, core::TriangleMesh>> objects{
      {"die", shapes::Box(0.016, 0.016, 0.016)},
      {"icosahedron", Scaled(shapes::Icosphere(0), Vector3d::Constant(0.02))},
      {"ring", shapes::Torus(0.04, 0.008, 48, 16)},
      {"bowl", shapes::Bowl(0.07, 0.006, 40)},
      {"bowl upside down",
       RoundShapesTurned(shapes::Bowl(0.07, 0.006, 40), shapes::kPi, Vector3d::UnitX())},
      {"half ball",
       shapes::Revolved({{0.0, 0.0}, {0.04, 0.0}, {0.0346, 0.02}, {0.02, 0.0346}, {0.0, 0.04}},
                        48)},
      {"cone on its tip",
       RoundShapesTurned(shapes::Cone(0.04, 0.1, 48), shapes::kPi, Vector3d::UnitX())}};
  for (const auto& [name, mesh] : objects) {
    const validation::CheckReport report = Checked(Built(mesh, "object"));
    EXPECT_NE(report.grade(), validation::Grade::kFail) << name << "\n"
                                                        << validation::CheckTable(report);
  }
}

// It starts on an edge, on which it balances in Bullet and from which it tips in MuJoCo.
TEST(RoundShapes, WhatOnlyBalancesIsLaidOnAFace) {
  const assets::Asset twenty =
      Built(Scaled(shapes::Icosphere(0), Vector3d::Constant(0.02)), "object");
  const Vector3d down = -Vector3d::UnitZ(), center = twenty.inertial.center_of_mass;
  // The inradius of a face over that of the body: atan(0.2887 / 0.7558).
  EXPECT_NEAR(geometry::TippingAngle(twenty.solid, center, down, 1e-7), 0.3649, 1e-3);
  const assets::Asset box =
      Built(RoundShapesTurned(shapes::Box(0.03, 0.03, 0.03), shapes::kPi / 4, Vector3d::UnitX()),
            "object");
  EXPECT_NEAR(geometry::TippingAngle(box.solid, box.inertial.center_of_mass, down, 1e-7),
              shapes::kPi / 4, 1e-3);
}

// A lying bottle or a ball is not stood up, or turned over, to make it rest.
TEST(RoundShapes, WhatRollsStaysAsItCame) {
  const assets::Asset bottle =
      Built(RoundShapesTurned(shapes::Cylinder(0.03, 0.2, 64), shapes::kPi / 2, Vector3d::UnitX()),
            "bottle");
  EXPECT_NEAR(core::Bounds(bottle.solid).sizes().z(), 0.06, 2e-3);
}

// Small faults warn; these cases must not.
TEST(RoundShapes, WhatIsReallyWrongFails) {
  const assets::Asset can = Built(shapes::Cylinder(0.03, 0.1, 48), "candle");
  ASSERT_EQ(Checked(can).grade(), validation::Grade::kPass);

  assets::Asset toppling = can;  // its centre of mass is outside its support polygon
  for (core::TriangleMesh& part : toppling.parts) {
    for (Vector3d& v : part.vertices) {
      if (v.z() < 0.05) v.x() = 0.2 * (v.x() - 0.03) + 0.03;
    }
    part = geometry::ConvexHull(part.vertices);
  }
  const validation::CheckReport fallen = Checked(toppling);
  EXPECT_EQ(fallen.grade(), validation::Grade::kFail);
  EXPECT_EQ(RowOf(fallen, "rest-pose-bullet")->severity, core::Severity::kError);
  EXPECT_EQ(RowOf(fallen, "rest-pose-mujoco")->severity, core::Severity::kError);

  // Marking it as rolling does not help a body that falls.
  toppling.rolls = true;
  EXPECT_EQ(Checked(toppling).grade(), validation::Grade::kFail);

  assets::Asset hollow = can;  // only half of it has collision parts
  for (core::TriangleMesh& part : hollow.parts) {
    for (Vector3d& v : part.vertices) v.z() = std::min(v.z(), 0.05);
    part = geometry::ConvexHull(part.vertices);
  }
  EXPECT_EQ(RowOf(Checked(hollow), "parts-cover")->severity, core::Severity::kError);

  assets::Asset heavy = can;  // its mass differs from asset.json
  heavy.inertial.mass *= 1.01;
  EXPECT_EQ(Checked(heavy).grade(), validation::Grade::kFail);
}

}  // namespace
}  // namespace simwright::asset_build
