#include "asset_lift/segmentation/mask_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::asset_lift {
namespace {

constexpr int kPhotoSide = 160;

bool InDisc(int x, int y, double cx, double cy, double radius) {
  return std::hypot(x + 0.5 - cx, y + 0.5 - cy) < radius;
}

core::Image DiscMask(double cx, double cy, double radius) {
  core::Image mask(kPhotoSide, kPhotoSide, 1);
  for (int y = 0; y < kPhotoSide; ++y) {
    for (int x = 0; x < kPhotoSide; ++x) *mask.At(x, y) = InDisc(x, y, cx, cy, radius) ? 255 : 0;
  }
  return mask;
}

// A red disc on a grey table with some noise.
core::Image DiscPhoto() {
  core::Image photo(kPhotoSide, kPhotoSide, 3);
  for (int y = 0; y < kPhotoSide; ++y) {
    for (int x = 0; x < kPhotoSide; ++x) {
      const int noise = (x * 31 + y * 17) % 13;
      const bool inside = InDisc(x, y, 80.0, 80.0, 40.0);
      photo.At(x, y)[0] = static_cast<std::uint8_t>(inside ? 190 + noise : 120 + noise);
      photo.At(x, y)[1] = static_cast<std::uint8_t>(inside ? 40 + noise : 118 + noise);
      photo.At(x, y)[2] = static_cast<std::uint8_t>(inside ? 35 + noise : 122 + noise);
    }
  }
  return photo;
}

double Iou(const core::Image& a, const core::Image& b) {
  double both = 0.0, either = 0.0;
  for (size_t p = 0; p < a.pixels.size(); ++p) {
    both += a.pixels[p] > 127 && b.pixels[p] > 127;
    either += a.pixels[p] > 127 || b.pixels[p] > 127;
  }
  return both / std::max(1.0, either);
}

TEST(RefinedMask, MovesARoughOutlineToTheEdge) {
  const core::Image truth = DiscMask(80.0, 80.0, 40.0);
  const core::Image rough = DiscMask(83.0, 78.0, 37.0), none(kPhotoSide, kPhotoSide, 1);
  EXPECT_LT(Iou(rough, truth), 0.88);
  EXPECT_GT(Iou(RefinedMask(DiscPhoto(), rough, none), truth), 0.97);
}

TEST(RefinedMask, LeavesOtherObjectsOut) {
  const core::Image rough = DiscMask(83.0, 78.0, 37.0);
  core::Image others(kPhotoSide, kPhotoSide, 1);
  for (int y = 0; y < kPhotoSide; ++y)
    std::fill_n(others.At(112, y), kPhotoSide - 112, std::uint8_t{255});
  const core::Image refined = RefinedMask(DiscPhoto(), rough, others);
  for (int y = 0; y < kPhotoSide; ++y) {
    for (int x = 114; x < kPhotoSide; ++x) {
      if (*rough.At(x, y) > 0) continue;
      EXPECT_EQ(*refined.At(x, y), 0) << x << " " << y;
    }
  }
}

TEST(RefinedMask, KeepsWhatItCannotImprove) {
  const core::Image none(kPhotoSide, kPhotoSide, 1);
  EXPECT_EQ(RefinedMask(DiscPhoto(), none, none).pixels, none.pixels);
  EXPECT_THROW(RefinedMask(DiscPhoto(), core::Image(8, 8, 1), none), core::Error);
}

}  // namespace
}  // namespace simwright::asset_lift
