// Peaks of visual hulls against the tops that the objects have.
#include "capture/flat_tops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capture/object_masks.h"
#include "capture/voting_hull.h"
#include "tests/capture/mat_photos.h"
#include "tests/geometry/solid_shapes.h"

namespace simwright::capture {
namespace {

// Views from 15, 38 and 62 degrees, 24 in all, as the guide to photos asks for.
std::vector<asset_lift::ObservedView> RingViews(const core::TriangleMesh& mesh) {
  std::vector<asset_lift::ObservedView> views;
  for (int k = 0; k < 24; ++k) {
    constexpr double kElevations[] = {15.0, 38.0, 62.0};  // deg
    asset_lift::ObservedView view;
    view.camera = core::OrbitCamera({0, 0, 0.03}, 0.5, kElevations[k % 3] * std::numbers::pi / 180,
                                    2.0 * std::numbers::pi * k / 24, 0.4, 240, 240);
    view.opacity = SilhouetteOf(mesh, view.camera);
    views.push_back(std::move(view));
  }
  return views;
}

geometry::ScalarGrid RingField(const std::vector<asset_lift::ObservedView>& views) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-0.08, -0.08, 0.0),
                                Eigen::Vector3d(0.08, 0.08, 0.1));
  return VotingHullField({{views, 0}}, box, {80, 0.0});
}

// Returns the greatest height of the surface.
double TopOf(const geometry::ScalarGrid& field) {
  return core::Bounds(geometry::ExtractIsosurface(field, 0.0f)).max().z();
}

TEST(FlatTops, LowersTheRoofOfABoxToItsTop) {
  constexpr double kTop = 0.04;  // m
  const auto views = RingViews(PlainBox({0.1, 0.08, kTop}, {0.5f, 0.5f, 0.5f}).mesh);
  geometry::ScalarGrid field = RingField(views);
  EXPECT_GT(TopOf(field), kTop + 0.005);  // the roof of cones
  LowerPeaks(views, {}, &field);
  EXPECT_NEAR(TopOf(field), kTop, 0.002);
}

// Two tops of different heights are lowered each to its own.
TEST(FlatTops, LowersEachPeakByItself) {
  core::TriangleMesh both = PlainBox({0.04, 0.06, 0.03}, {0.5f, 0.5f, 0.5f}).mesh;
  core::TriangleMesh high = PlainBox({0.04, 0.06, 0.06}, {0.5f, 0.5f, 0.5f}).mesh;
  for (Eigen::Vector3d& v : both.vertices) v.x() -= 0.045;
  const Eigen::Vector3i first = Eigen::Vector3i::Constant(static_cast<int>(both.vertices.size()));
  for (const Eigen::Vector3d& v : high.vertices)
    both.vertices.push_back(v + Eigen::Vector3d(0.045, 0, 0));
  for (const Eigen::Vector3i& t : high.triangles) both.triangles.push_back(t + first);
  const auto views = RingViews(both);
  geometry::ScalarGrid field = RingField(views);
  LowerPeaks(views, {}, &field);
  const core::TriangleMesh mesh = geometry::ExtractIsosurface(field, 0.0f);
  double left = 0.0, right = 0.0;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    (v.x() < -0.02 ? left : right) = std::max(v.x() < -0.02 ? left : right, v.z());
  }
  EXPECT_NEAR(left, 0.03, 0.0025);
  EXPECT_NEAR(right, 0.06, 0.0025);
}

// The outlines of a ball stop the plane: its top keeps its height.
TEST(FlatTops, KeepsARoundTop) {
  constexpr double kRadius = 0.04;  // m
  core::TriangleMesh ball = shapes::Icosphere(4);
  for (Eigen::Vector3d& v : ball.vertices) v = kRadius * (v + Eigen::Vector3d::UnitZ());
  const auto views = RingViews(ball);
  geometry::ScalarGrid field = RingField(views);
  LowerPeaks(views, {}, &field);
  EXPECT_NEAR(TopOf(field), 2.0 * kRadius, 0.003);
}

}  // namespace
}  // namespace simwright::capture
