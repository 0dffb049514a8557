#include "asset_lift/camera/view_frame.h"

#include <gtest/gtest.h>

#include <cmath>

namespace simwright::asset_lift {
namespace {

ViewFrame SampleFrame() {
  ViewFrame frame;
  frame.camera = core::OrbitCamera({0.1, 0.2, 0.3}, 2.0, 0.4, 1.0, 0.6, 200, 160);
  frame.center_x = 120;
  frame.center_y = 70;
  frame.half = 40;
  frame.depth = 1.9;
  return frame;
}

TEST(ViewFrame, PointsAndPlacesInTheBlockAreEachOthersInverse) {
  const ViewFrame frame = SampleFrame();
  for (const Eigen::Vector3d& uvw :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.5, -0.7, 1.1), Eigen::Vector3d(-1, 1, -1.2)}) {
    EXPECT_LT((frame.Locate(frame.PointAt(uvw)) - uvw).norm(), 1e-12);
  }
  // The middle lies at the frame's depth along the central ray, and a unit of w is the radius.
  EXPECT_NEAR((frame.PointAt({0, 0, 0}) - frame.camera.position()).norm(), 1.9, 1e-12);
  EXPECT_NEAR((frame.PointAt({0, 0, 1}) - frame.PointAt({0, 0, 0})).norm(), frame.Radius(), 1e-12);
}

TEST(ViewFrame, TheCropsCameraSeesWhatTheCropShows) {
  const ViewFrame frame = SampleFrame();
  const core::Camera crop = frame.CropCamera(64);
  const Eigen::Vector3d pixel = crop.Project(frame.PointAt({0.25, -0.5, 0.3}));
  EXPECT_NEAR(pixel.x(), 64 * 0.5 * 1.25, 1e-9);
  EXPECT_NEAR(pixel.y(), 64 * 0.5 * 0.5, 1e-9);
}

TEST(CropView, AveragesColoursByAreaAndLeavesTheBackgroundOut) {
  ViewFrame frame = SampleFrame();
  core::Image photo(200, 160, 3), alpha(200, 160, 1);
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      const bool object = x >= 100 && x < 140 && y >= 50 && y < 90;
      alpha.At(x, y)[0] = object ? 255 : 0;
      photo.At(x, y)[0] = object ? 51 : 255;  // a background that must not bleed in
      photo.At(x, y)[1] = object && x < 120 ? 204 : 0;
    }
  }
  const ObservedView view = CropView(photo, alpha, frame, 20);  // 4 pixels to one
  EXPECT_NEAR(view.opacity.At(10, 10)[0], 1.0f, 1e-6);
  EXPECT_EQ(view.opacity.At(2, 2)[0], 0.0f);
  EXPECT_NEAR(view.color.At(10, 10)[0], 0.2f, 1e-6);
  EXPECT_NEAR(view.color.At(7, 10)[1], 0.8f, 1e-6);
  EXPECT_NEAR(view.color.At(12, 10)[1], 0.0f, 1e-6);
}

TEST(FrameAround, HoldsTheMattesBoxWithItsMargin) {
  Matte matte;
  matte.left = 20, matte.right = 60, matte.top = 30, matte.bottom = 130;
  const ViewFrame frame = FrameAround(matte, SampleFrame().camera, 1.0, 1.2);
  EXPECT_EQ(frame.center_x, 40);
  EXPECT_EQ(frame.center_y, 80);
  EXPECT_NEAR(frame.half, 60, 1e-12);
}

}  // namespace
}  // namespace simwright::asset_lift
