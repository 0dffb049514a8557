#include "capture/object_masks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "capture/mat_evidence.h"

namespace simwright::capture {
namespace {

constexpr int kPixels = 120;

// A photo of a chequered mat on a table of `table`, with a rectangle of the colour `object` on the
// mat, where the comparison with the mat gave `difference` and `pattern`.
struct RectangleOnMat {
  core::Image photo = core::Image(kPixels, kPixels, 3);
  MatEvidence evidence;
  core::FloatImage truth = core::FloatImage(kPixels, kPixels, 1);
};

RectangleOnMat MakeRectangle(int width, int height, const Eigen::Vector3i& object,
                             const Eigen::Vector3i& table, float difference, float pattern) {
  RectangleOnMat made;
  made.evidence.albedo = made.evidence.difference = made.evidence.pattern =
      core::FloatImage(kPixels, kPixels, 1);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 3.0);
  for (int y = 0; y < kPixels; ++y) {
    for (int x = 0; x < kPixels; ++x) {
      const bool on_mat = y >= 40;
      const bool inside = 2 * std::abs(x - 60) < width && 2 * std::abs(y - 80) < height;
      const bool dark = (x / 10 + y / 10) % 2 == 0;
      *made.evidence.difference.At(x, y) = inside ? difference : on_mat ? 0.5f : -1.0f;
      *made.evidence.pattern.At(x, y) = inside ? pattern : on_mat ? 0.95f : 0.0f;
      *made.truth.At(x, y) = inside;
      const Eigen::Vector3i mat =
          dark ? Eigen::Vector3i(127, 0, 92) : Eigen::Vector3i(183, 237, 194);
      const Eigen::Vector3i& color = inside ? object : on_mat ? mat : table;
      for (int c = 0; c < 3; ++c) {
        made.photo.At(x, y)[c] =
            static_cast<std::uint8_t>(std::clamp(color[c] + noise(random), 0.0, 255.0));
      }
    }
  }
  return made;
}

double IouOf(const RectangleOnMat& made) {
  const core::FloatImage mask = SegmentOnMat(made.photo, made.evidence, {}, nullptr).opacity;
  double both = 0.0, either = 0.0;
  for (std::size_t i = 0; i < mask.values.size(); ++i) {
    const bool a = mask.values[i] >= 0.5f, b = made.truth.values[i] >= 0.5f;
    both += a && b;
    either += a || b;
  }
  return both / either;
}

// In few pixels black differs little from the mat in a deep shadow, but the pattern is missing.
TEST(ObjectMasks, ABlackObjectIsNoShadow) {
  EXPECT_GT(IouOf(MakeRectangle(50, 40, {16, 16, 18}, {120, 84, 56}, 2.2f, 0.1f)), 0.9);
}

// Windows around thin parts show the mat's pattern, and the table teaches GrabCut their colour.
TEST(ObjectMasks, AThinObjectOfTheTablesColourIsFound) {
  EXPECT_GT(IouOf(MakeRectangle(90, 5, {120, 84, 56}, {120, 84, 56}, 12.0f, 0.6f)), 0.9);
}

TEST(ObjectMasks, WhatNoOtherPhotoShowsBesideTheMatIsCut) {
  MatEvidence evidence;
  evidence.difference = core::FloatImage(kPixels, kPixels, 1);
  core::FloatImage hull(kPixels, kPixels, 1), opacity(kPixels, kPixels, 1, 1.0f);
  for (int y = 0; y < kPixels; ++y) {
    for (int x = 0; x < kPixels; ++x) {
      if (x < 50) *evidence.difference.At(x, y) = -1.0f;
      if (std::abs(x - 50) < 20 && std::abs(y - 50) < 20) *hull.At(x, y) = 1.0f;
    }
  }
  ClipBesideMat(evidence, hull, &opacity);
  EXPECT_EQ(*opacity.At(10, 50), 0.0f);  // beside the mat, outside the hull
  EXPECT_EQ(*opacity.At(40, 50), 1.0f);
  EXPECT_EQ(*opacity.At(29, 50), 1.0f);  // within the hull's margin
  EXPECT_EQ(*opacity.At(90, 50), 1.0f);  // over the mat
}

}  // namespace
}  // namespace simwright::capture
