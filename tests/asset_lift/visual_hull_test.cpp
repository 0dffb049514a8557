#include "asset_lift/multi_view/visual_hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "asset_lift/multi_view/view_consistency.h"
#include "core/error.h"
#include "geometry/mesh_validity.h"
#include "geometry/surface_distance.h"
#include "geometry/weld.h"
#include "tests/asset_lift/fit_scene.h"

namespace simwright::asset_lift {
namespace {

std::vector<ObservedView> WithoutDepths(std::vector<ObservedView> views) {
  for (ObservedView& view : views) view.depth = {};
  return views;
}

TEST(VisualHull, DistanceToADisksOutline) {
  core::FloatImage disk(41, 41, 1);
  for (int y = 0; y < 41; ++y) {
    for (int x = 0; x < 41; ++x) {
      const double inside = 12.0 - std::hypot(x - 20.0, y - 20.0);
      *disk.At(x, y) = static_cast<float>(std::clamp(inside + 0.5, 0.0, 1.0));
    }
  }
  const core::FloatImage distance = MaskDistance(disk);
  for (int y = 0; y < 41; ++y) {
    for (int x = 0; x < 41; ++x) {
      EXPECT_NEAR(*distance.At(x, y), std::hypot(x - 20.0, y - 20.0) - 12.0, 0.75);
    }
  }
}

TEST(VisualHull, OfASphereIsASphere) {
  const core::TriangleMesh sphere = Sphere(0.1);
  VisualHullOptions options;
  options.cells = 64;
  const core::TriangleMesh hull = VisualHull(WithoutDepths(ViewsOf(sphere, 12, 64)), options);
  EXPECT_TRUE(geometry::Examine(hull).IsSolid());
  // Twelve cones about a ball hold a little more than the ball.
  const double ball = 4.0 / 3.0 * std::numbers::pi * 1e-3;
  EXPECT_GT(geometry::SignedVolume(hull), 0.97 * ball);
  EXPECT_LT(geometry::SignedVolume(hull), 1.15 * ball);
}

// No silhouette shows a bowl's hollow; depths do, and so do patterned colours.
TEST(VisualHull, DepthsAndColoursOpenAHollow) {
  const core::TriangleMesh bowl = SurfaceOf(
      [](const Eigen::Vector3d& p) {
        const double shell = std::abs(p.norm() - 0.09) - 0.01;
        return std::max(shell, p.z() - 0.02);
      },
      0.12, 60);
  std::vector<ObservedView> views = ViewsOf(bowl, 16, 96);
  VisualHullOptions options;
  options.cells = 60;
  const double volume = geometry::SignedVolume(bowl);
  const double with_depths = geometry::SignedVolume(VisualHull(views, options));
  views = WithoutDepths(views);
  const double by_masks = geometry::SignedVolume(VisualHull(views, options));
  options.color_tolerance = 0.1;
  const double by_colours = geometry::SignedVolume(VisualHull(views, options));
  EXPECT_GT(by_masks, 1.8 * volume);
  EXPECT_NEAR(with_depths, volume, 0.3 * volume);
  EXPECT_LT(by_colours, 0.5 * (by_masks + volume));
  EXPECT_GT(by_colours, 0.8 * volume);
}

// Where no colours agree, carving is skipped instead of eroding the object.
TEST(VisualHull, ColoursThatNeverAgreeCarveNothing) {
  std::vector<ObservedView> views = WithoutDepths(ViewsOf(Sphere(0.1), 8, 48));
  VisualHullOptions options;
  options.cells = 40;
  const double plain = geometry::SignedVolume(VisualHull(views, options));
  for (std::size_t i = 0; i < views.size(); ++i) {
    std::fill(views[i].color.values.begin(), views[i].color.values.end(), i % 2 ? 0.9f : 0.1f);
  }
  options.color_tolerance = 0.1;
  EXPECT_EQ(geometry::SignedVolume(VisualHull(views, options)), plain);
}

TEST(VisualHull, BadViewsAreNamed) {
  const std::vector<ObservedView> good = ViewsOf(Sphere(0.1), 3, 24);
  const auto message = [&](const std::vector<ObservedView>& views) -> std::string {
    try {
      VisualHull(views);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(good), "");
  EXPECT_NE(message({good[0]}), "");
  std::vector<ObservedView> views = good;
  views[1].opacity = core::FloatImage(24, 24, 1);
  EXPECT_NE(message(views).find("view 1"), std::string::npos);
  views = good;
  views[2].color = core::FloatImage(8, 8, 3);
  EXPECT_NE(message(views).find("view 2"), std::string::npos);
  views = good;
  views[0].opacity.values[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(message(views).find("view 0"), std::string::npos);
  views = good;
  views[1].camera.world_from_camera.translation() += Eigen::Vector3d(0.0, 0.0, 2.0);
  EXPECT_NE(message(views).find("contradict the others: 1"), std::string::npos) << message(views);
}

ObservedView Turned(ObservedView view, double angle) {
  view.camera.world_from_camera =
      Eigen::Isometry3d(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())) *
      view.camera.world_from_camera;
  return view;
}

TEST(ViewConsistency, TrueCamerasAgree) {
  const ViewConsistency agreement = CheckViewConsistency(ViewsOf(Hook(), 8, 64));
  EXPECT_TRUE(agreement.contradicting.empty());
  EXPECT_TRUE(agreement.findings.empty());
  ASSERT_EQ(agreement.unexplained.size(), 8u);
  for (const double share : agreement.unexplained) EXPECT_LT(share, 0.03);
}

TEST(ViewConsistency, AWrongCameraIsNamed) {
  const std::vector<ObservedView> good = ViewsOf(Hook(), 8, 64);
  for (const int wrong : {0, 3, 6}) {
    std::vector<ObservedView> views = good;
    views[wrong] = Turned(views[wrong], 0.7);
    const ViewConsistency agreement = CheckViewConsistency(views);
    EXPECT_EQ(agreement.contradicting, std::vector<int>{wrong});
    ASSERT_EQ(agreement.findings.size(), 1u);
    EXPECT_EQ(agreement.findings[0].place, "view " + std::to_string(wrong));
    EXPECT_GT(agreement.findings[0].figure, 0.06);
  }
}

TEST(ViewConsistency, TwoWrongCamerasAreNamed) {
  std::vector<ObservedView> views = ViewsOf(Hook(), 9, 64);
  views[2] = Turned(views[2], 0.8);
  views[5] = Turned(views[5], -1.1);
  EXPECT_EQ(CheckViewConsistency(views).contradicting, (std::vector<int>{2, 5}));
}

// If two views contradict each other, it is undecidable which is wrong.
TEST(ViewConsistency, OfTwoViewsBothAreNamed) {
  std::vector<ObservedView> views = ViewsOf(Hook(), 2, 64);
  EXPECT_TRUE(CheckViewConsistency(views).contradicting.empty());
  // The picture's upper half is cut off: the other view shows more than this one allows.
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) *views[1].opacity.At(x, y) = 0.0f;
  }
  EXPECT_EQ(CheckViewConsistency(views).contradicting, (std::vector<int>{0, 1}));
}

}  // namespace
}  // namespace simwright::asset_lift
