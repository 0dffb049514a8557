// The shape that a fit of a capture starts from.
#include "capture/start_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "capture/object_masks.h"
#include "capture/voting_hull.h"
#include "tests/capture/mat_photos.h"

namespace simwright::capture {
namespace {

// A box seen by 24 cameras, with exact masks.
Capture BoxCapture(const Eigen::Vector3d& sides) {
  Capture capture;
  capture.hull = PlainBox(sides, {0.5f, 0.5f, 0.5f}).mesh;
  for (int k = 0; k < 24; ++k) {
    constexpr double kElevations[] = {15.0, 38.0, 62.0};  // deg
    CaptureView view;
    view.camera = core::OrbitCamera({0, 0, 0.03}, 0.5, kElevations[k % 3] * std::numbers::pi / 180,
                                    2.0 * std::numbers::pi * k / 24, 0.4, 320, 320);
    view.opacity = SilhouetteOf(capture.hull, view.camera);
    capture.views.push_back(std::move(view));
  }
  return capture;
}

Eigen::Vector3d StartSize(const Capture& capture, const StartShapeOptions& options) {
  core::Progress silent;
  return core::Bounds(MakeStartShape(capture, options, &silent).mesh).sizes();
}

// Returns the size of the visual hull: what all masks admit.
Eigen::Vector3d HullSize(const Capture& capture) {
  HullVote vote;
  vote.tolerated = 0;
  for (const CaptureView& view : capture.views) {
    vote.views.push_back({});
    vote.views.back().camera = view.camera;
    vote.views.back().opacity = view.opacity;
  }
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-0.06, -0.06, 0), Eigen::Vector3d(0.06, 0.06, 0.1));
  return core::Bounds(VotingHull({vote}, box, {128, 0.0})).sizes();
}

// The sides are those of the visual hull, and the top is the box's. A tolerated view lets the sides
// bulge that few views look along.
TEST(StartShape, ABoxHasItsSides) {
  const Eigen::Vector3d sides(0.06, 0.045, 0.05);  // m
  const Capture capture = BoxCapture(sides);
  StartShapeOptions tolerant;
  tolerant.least_agreement = 2.0;  // no mask is believed
  const Eigen::Vector3d size = StartSize(capture, {}), bulged = StartSize(capture, tolerant);
  const Eigen::Vector3d hull = HullSize(capture);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(size[k], hull[k], 0.0005) << k;
  EXPECT_NEAR(size[2], sides[2], 0.001);
  EXPECT_GT((bulged - size).head<2>().maxCoeff(), 0.0004);
}

// Neither a hole in a mask nor a mask without half of the object cuts the shape.
TEST(StartShape, WrongMasksCutNothing) {
  const Eigen::Vector3d sides(0.06, 0.045, 0.05);  // m
  Capture capture = BoxCapture(sides);
  const Eigen::Vector3d whole = StartSize(capture, {});
  for (int y = 150; y < 165; ++y) {
    for (int x = 150; x < 165; ++x) *capture.views[3].opacity.At(x, y) = 0.0f;
  }
  for (int y = 0; y < 320; ++y) {
    for (int x = 0; x < 160; ++x) *capture.views[7].opacity.At(x, y) = 0.0f;
  }
  const Eigen::Vector3d size = StartSize(capture, {});
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(size[k], whole[k], 0.001) << k;
}

}  // namespace
}  // namespace simwright::capture
