#include "twin/pose_uncertainty.h"

#include <gtest/gtest.h>

#include <cmath>

#include "twin/table_camera.h"

namespace simwright::twin {
namespace {

// Straight below a camera the formula has a closed form: e d / f on both axes.
TEST(UncertaintyOf, IsThatOfTheOutlineInMetres) {
  const core::Camera camera = TableCamera{1.5, 0.0, 1.0, 2.0}.At(500, 400);
  TableFit fit;
  fit.instance.size = {0.2, 0.1, 0.1};
  fit.pose = {0.0, 0.0, 0.0};
  fit.agreement.iou = 1.0;
  const Eigen::AlignedBox2d box(Eigen::Vector2d(100, 100), Eigen::Vector2d(130, 140));
  const PoseUncertainty exact = UncertaintyOf(fit, box, camera, false, 0.0);
  const double across = 0.004 * 500 * 2.0 / 500.0;
  EXPECT_NEAR(exact.position, across, 1e-12);
  EXPECT_NEAR(exact.yaw, across / 0.1, 1e-12);
  EXPECT_NEAR(exact.size, 2.0 / 50.0, 1e-12);
  EXPECT_NEAR(UncertaintyOf(fit, box, camera, true, 0.0).position, 2.0 * across, 1e-12);
  EXPECT_NEAR(UncertaintyOf(fit, box, camera, false, 0.1).size, std::hypot(0.04, 0.1), 1e-12);
  fit.agreement.iou = 0.5;
  EXPECT_GT(UncertaintyOf(fit, box, camera, false, 0.0).position, exact.position);
}

// Seen flatly, the distance from the camera is less certain than the place across.
TEST(UncertaintyOf, GrowsUnderFlatViews) {
  TableFit fit;
  fit.instance.size = {0.2, 0.1, 0.1};
  fit.pose = {0.0, 1.0, 0.0};
  fit.agreement.iou = 0.9;
  const Eigen::AlignedBox2d box(Eigen::Vector2d(100, 100), Eigen::Vector2d(130, 140));
  const double steep =
      UncertaintyOf(fit, box, TableCamera{0.9, 0.0, 1.0, 1.2}.At(500, 400), false, 0.0).position;
  const double flat =
      UncertaintyOf(fit, box, TableCamera{0.2, 0.0, 1.0, 0.2}.At(500, 400), false, 0.0).position;
  EXPECT_GT(flat, 1.5 * steep);
}

}  // namespace
}  // namespace simwright::twin
