// A straight-walled vessel keeps its walls: no shoulder if the camera's elevation is estimated
// slightly too low, no bulge if a handle widens the silhouette on one side.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "asset_lift/outline/inflation.h"
#include "asset_lift/outline/upright_body.h"

namespace simwright::asset_lift {
namespace {

constexpr int kSide = 480;
constexpr double kRadius = 0.1, kRimHeight = 0.3;  // the camera is 1 away
constexpr double kDegree = M_PI / 180.0;

core::Camera CameraAt(double elevation_degrees) {
  Matte matte;  // centred
  matte.alpha = core::Image(kSide, kSide, 1);
  matte.left = matte.top = kSide / 4;
  matte.right = matte.bottom = kSide - kSide / 4;
  return PhotoCamera(matte, 760.0, elevation_degrees * kDegree);
}

UprightBody UprightRimCylinder() {
  UprightBody body;
  constexpr int kLevels = 60;
  body.bottom = -0.5 * kRimHeight;
  body.step = kRimHeight / (kLevels - 1);
  body.radius.assign(kLevels, kRadius);
  return body;
}

double RadiusAtShare(const UprightBody& body, double share) {
  return body.RadiusAt(body.bottom + share * (body.top() - body.bottom));
}

TEST(UprightRim, AWronglyEstimatedElevationMakesNoShoulder) {
  const cv::Mat mask = Silhouette(UprightRimCylinder(), CameraAt(20.0));
  for (const double estimated : {11.0, 14.0, 17.0}) {
    UprightBody body = FitUprightBody(mask, CameraAt(estimated));
    if (estimated < 15.0) {
      EXPECT_LT(RadiusAtShare(body, 0.99), 0.9 * RadiusAtShare(body, 0.5)) << estimated;
    }
    ASSERT_TRUE(RestoreRim(mask, CameraAt(estimated), &body)) << estimated;
    for (const double share : {0.05, 0.25, 0.75, 0.9, 0.97, 1.0}) {
      EXPECT_NEAR(RadiusAtShare(body, share), RadiusAtShare(body, 0.5), 0.05 * kRadius)
          << estimated << " " << share;
    }
    // Its silhouette covers the mask as before.
    const cv::Mat drawn = Silhouette(body, CameraAt(estimated));
    const double both = cv::countNonZero(drawn & mask), either = cv::countNonZero(drawn | mask);
    EXPECT_GT(both / either, 0.94) << estimated;
  }
}

TEST(UprightRim, WhatNarrowsTowardsItsTopStaysSo) {
  UprightBody cone = UprightRimCylinder();
  for (size_t i = 0; i < cone.radius.size(); ++i) {
    cone.radius[i] = kRadius * (1.0 - 0.5 * static_cast<double>(i) / 59.0);
  }
  const cv::Mat mask = Silhouette(cone, CameraAt(20.0));
  UprightBody body = FitUprightBody(mask, CameraAt(20.0));
  RestoreRim(mask, CameraAt(20.0), &body);
  EXPECT_NEAR(RadiusAtShare(body, 0.97) / RadiusAtShare(body, 0.03), 0.53, 0.06);
}

// The mask of a body as a matte, seen at 20 degrees with a focal length, pixels.
Matte MatteOfBody(const UprightBody& body, double focal) {
  Matte matte;
  matte.alpha = core::Image(kSide, kSide, 1);
  matte.left = matte.top = kSide / 4;
  matte.right = matte.bottom = kSide - kSide / 4;
  const cv::Mat mask = Silhouette(body, PhotoCamera(matte, focal, 20.0 * kDegree));
  for (int y = 0; y < kSide; ++y) std::copy_n(mask.ptr(y), kSide, matte.alpha.At(0, y));
  const cv::Rect box = cv::boundingRect(mask);
  matte.left = box.x, matte.top = box.y;
  matte.right = box.x + box.width, matte.bottom = box.y + box.height;
  return matte;
}

// The body of the tests, its radius at the top over that at the bottom, scaled to look equally
// large at another focal length.
UprightBody TaperedBody(double top_over_bottom, double scale) {
  UprightBody body = UprightRimCylinder();
  body.bottom *= scale;
  body.step *= scale;
  for (size_t i = 0; i < body.radius.size(); ++i) {
    body.radius[i] *= scale * (1.0 + (top_over_bottom - 1.0) * static_cast<double>(i) / 59.0);
  }
  return body;
}

TEST(StraightWalls, GiveTheFocalLengthOfATumblersPhoto) {
  constexpr double kAssumed = 760.0;
  for (const double true_focal : {600.0, 1500.0, 3000.0}) {
    const Matte matte = MatteOfBody(TaperedBody(1.0, kAssumed / true_focal), true_focal);
    const auto found = StraightWallFocal(matte, kAssumed, 20.0 * kDegree);
    ASSERT_TRUE(found) << true_focal;
    EXPECT_NEAR(std::log(*found / true_focal), 0.0, std::log(1.5)) << true_focal;
  }
  // A focal length that is right is kept, and so is a cone.
  EXPECT_FALSE(
      StraightWallFocal(MatteOfBody(TaperedBody(1.0, 1.0), kAssumed), kAssumed, 20.0 * kDegree));
  EXPECT_FALSE(
      StraightWallFocal(MatteOfBody(TaperedBody(0.75, 1.0), kAssumed), kAssumed, 20.0 * kDegree));
}

TEST(UprightRim, AHandleDoesNotWidenTheWall) {
  const core::Camera camera = CameraAt(20.0);
  cv::Mat mask = Silhouette(UprightRimCylinder(), camera);
  const Eigen::Vector3d side = camera.Project({kRadius, 0.0, 0.0});
  cv::ellipse(mask, cv::Point(static_cast<int>(side.x()), static_cast<int>(side.y())),
              cv::Size(55, 65), 0.0, -90.0, 90.0, cv::Scalar(255), 16);
  const UprightBody body = FitUprightBody(mask, camera);
  EXPECT_NEAR(body.axis_x, 0.0, 0.02 * kRadius);
  for (const double share : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}) {
    EXPECT_NEAR(RadiusAtShare(body, share), kRadius, 0.03 * kRadius) << share;
  }
}

}  // namespace
}  // namespace simwright::asset_lift
