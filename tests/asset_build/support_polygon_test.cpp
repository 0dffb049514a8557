#include "asset_build/support_polygon.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "asset_build/rest_pose.h"
#include "core/random.h"
#include "geometry/convex_hull.h"
#include "geometry/hull_simplify.h"
#include "geometry/mesh_validity.h"
#include "geometry/weld.h"

namespace simwright::asset_build {
namespace {

using Eigen::Vector3d;

core::TriangleMesh Plate(double noise) {
  core::Rng rng(5);
  std::vector<Vector3d> points;
  for (int i = 0; i <= 10; ++i) {
    for (const double y : {-0.02, 0.02}) {
      points.emplace_back(0.03 * (i - 5), y, noise * core::Uniform(rng));
      points.emplace_back(0.03 * (i - 5), y, 0.004);
    }
  }
  return geometry::ConvexHull(points);
}

// A cylinder's support polygon in a hull of few vertices.
core::TriangleMesh Can(int corners) {
  std::vector<Vector3d> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    for (const double z : {0.0, 0.1}) {
      points.emplace_back(0.03 * std::cos(angle), 0.03 * std::sin(angle), z);
    }
  }
  return geometry::ConvexHull(points);
}

int VerticesAt(const core::TriangleMesh& part, const SupportPolygon& support) {
  int count = 0;
  for (const Vector3d& p : part.vertices) {
    count += std::abs(p.dot(support.down) - support.reach) < 1e-12;
  }
  return count;
}

TEST(SupportPolygon, OfABoxIsItsLowerFace) {
  const SupportPolygon support = FindSupportPolygon(Plate(0.0), {0, 0, 0.002}, 12);
  EXPECT_NEAR((support.down + Vector3d::UnitZ()).norm(), 0.0, 1e-9);
  EXPECT_NEAR(support.reach, 0.0, 1e-12);
  ASSERT_EQ(support.corners.size(), 4u);
  for (const Vector3d& corner : support.corners) {
    EXPECT_NEAR(std::abs(corner.x()), 0.15, 1e-12);
    EXPECT_NEAR(std::abs(corner.y()), 0.02, 1e-12);
  }
}

TEST(SupportPolygon, OneThatIsNearlyFlatBecomesFlat) {
  const core::TriangleMesh uneven = Plate(3e-4);
  const SupportPolygon support = FindSupportPolygon(uneven, {0, 0, 0.002}, 12);
  EXPECT_GT(-support.down.z(), 0.99);
  std::vector<core::TriangleMesh> parts{uneven};
  ASSERT_LT(VerticesAt(parts[0], support), 4);
  PreserveSupportFace(support, 64, &parts);
  EXPECT_GE(VerticesAt(parts[0], support), 4);
  EXPECT_LE(VerticesAt(parts[0], support), 32);
  // No vertex between the support face and the upper face is left to rock on.
  for (const Vector3d& p : parts[0].vertices) {
    const double above = support.reach - p.dot(support.down);
    EXPECT_TRUE(above < 1e-12 || above > 0.003) << above;
  }
  EXPECT_TRUE(geometry::Examine(parts[0]).IsSolid());
}

// Returns the smallest extent of the support polygon over all directions.
double LeastReach(const core::TriangleMesh& part, const SupportPolygon& support) {
  double least = INFINITY;
  for (int i = 0; i < 360; ++i) {
    const double angle = i * std::numbers::pi / 180.0;
    double reach = 0.0;
    for (const Vector3d& p : part.vertices) {
      if (std::abs(p.dot(support.down) - support.reach) > 1e-12) continue;
      reach = std::max(reach, p.x() * std::cos(angle) + p.y() * std::sin(angle));
    }
    least = std::min(least, reach);
  }
  return least;
}

TEST(SupportPolygon, ARoundOneKeepsItsCornersAndItsReach) {
  for (const int sides : {8, 12, 16, 24, 32, 40, 64}) {
    const core::TriangleMesh can = Can(sides);
    const SupportPolygon support = FindSupportPolygon(can, {0, 0, 0.05}, 12);
    std::vector<core::TriangleMesh> parts{
        geometry::SimplifyHull(can, 52)};  // as the decomposition does
    const double volume = geometry::SignedVolume(can);
    PreserveSupportFace(support, 64, &parts);
    EXPECT_GE(VerticesAt(parts[0], support), std::clamp(sides, 16, 24));
    EXPECT_LE(VerticesAt(parts[0], support), 32);
    EXPECT_LE(parts[0].vertices.size(), 64u);
    EXPECT_GT(LeastReach(parts[0], support),
              0.03 * std::cos(std::numbers::pi / std::min(sides, 24)) - 1e-9);
    EXPECT_NEAR(geometry::SignedVolume(parts[0]) / volume, 1.0, 0.01);
    EXPECT_TRUE(geometry::Examine(parts[0]).IsSolid());
  }
}

// A coin is thinner than the face tolerance of larger bodies.
TEST(SupportPolygon, ADiscStaysAsThickAsItIs) {
  core::TriangleMesh disc = Can(32);
  for (Vector3d& p : disc.vertices) p.z() *= 0.002;
  std::vector<core::TriangleMesh> parts{geometry::SimplifyHull(disc, 52)};
  PreserveSupportFace(FindSupportPolygon(disc, {0, 0, 1e-4}, 12), 64, &parts);
  EXPECT_NEAR(geometry::SignedVolume(parts[0]) / geometry::SignedVolume(disc), 1.0, 0.01);
  EXPECT_NEAR(core::Bounds(parts[0]).sizes().z(), 2e-4, 1e-12);
}

// A ball of few vertices has the volume of one of many, and its vertices stick out.
TEST(SupportPolygon, NothingReachesBelowAPoint) {
  const SupportPolygon support{-Vector3d::UnitZ(), 1.0, {Vector3d(0.0, 0.0, -1.0)}};
  std::vector<core::TriangleMesh> parts{
      geometry::ConvexHull({{0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}, {0, 0, -1.05}})};
  PreserveSupportFace(support, 64, &parts);
  EXPECT_NEAR(core::Bounds(parts[0]).min().z(), -1.0, 1e-12);
  EXPECT_EQ(parts[0].vertices.size(), 5u);
}

// Lost corners of the support polygon are restored from the solid.
TEST(SupportPolygon, ALostOneComesBack) {
  const core::TriangleMesh can = Can(64);
  std::vector<Vector3d> points{{0, 0, -2e-4}};
  for (const Vector3d& p : can.vertices) {
    points.push_back(p.z() > 0.05 ? p : Vector3d(0.8 * p.x(), 0.8 * p.y(), 1e-4));
  }
  const SupportPolygon support = FindSupportPolygon(can, {0, 0, 0.05}, 12);
  std::vector<core::TriangleMesh> parts{geometry::SimplifyHull(geometry::ConvexHull(points), 52)};
  PreserveSupportFace(support, 64, &parts);
  EXPECT_NEAR(core::Bounds(parts[0]).min().z(), 0.0, 1e-12);
  // Twelve of 64 corners, at most six steps apart.
  EXPECT_GT(LeastReach(parts[0], support), 0.03 * std::cos(6 * std::numbers::pi / 64) - 1e-9);
}

TEST(SupportPolygon, PartsAboveItStayAsTheyAre) {
  core::TriangleMesh lid = Can(12);
  for (Vector3d& p : lid.vertices) p.z() += 0.2;
  std::vector<core::TriangleMesh> parts{Can(12), lid};
  PreserveSupportFace(FindSupportPolygon(Can(12), {0, 0, 0.05}, 12), 64, &parts);
  EXPECT_EQ(parts[1].vertices, lid.vertices);
}

TEST(RestSentence, SaysHowItWasTurned) {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  EXPECT_EQ(RestSentence(turn, false), "stands in its given pose");
  turn.linear() = Eigen::AngleAxisd(1.0, Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_EQ(RestSentence(turn, false), "stands in its given pose");  // yaw is arbitrary
  turn.linear() = Eigen::AngleAxisd(0.1, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_NE(RestSentence(turn, false).find("nearly"), std::string::npos);
  EXPECT_NE(RestSentence(turn, false).find("6 degrees"), std::string::npos);
  turn.linear() = Eigen::AngleAxisd(1.5, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_FALSE(IsUprightAsGiven(turn));
  EXPECT_NE(RestSentence(turn, false).find("does not stand"), std::string::npos);
}

}  // namespace
}  // namespace simwright::asset_build
