#include "twin/detected_pixels.h"

#include <gtest/gtest.h>

#include <cmath>

namespace simwright::twin {
namespace {

// Two discs that touch, each with its own centre.
TEST(GroupPixels, SeparatesTouchingObjectsByTheirCentres) {
  DetectedPixels pixels;
  pixels.width = 60;
  pixels.height = 40;
  const Eigen::Vector2f centres[] = {{20.0f, 20.0f}, {38.0f, 20.0f}};
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      const Eigen::Vector2f at(x, y);
      const int nearer = (at - centres[0]).norm() <= (at - centres[1]).norm() ? 0 : 1;
      const bool inside = (at - centres[nearer]).norm() <= 9.0f;
      pixels.object.push_back(inside ? 0.9f : 0.1f);
      float heat = 0.0f;
      for (const Eigen::Vector2f& centre : centres) {
        heat = std::max(heat, std::exp(-0.1f * (at - centre).squaredNorm()));
      }
      pixels.centre.push_back(heat);
      pixels.offset.push_back(0.9f * (centres[nearer] - at));
    }
  }
  const PixelGroups groups = GroupPixels(pixels);
  ASSERT_EQ(groups.centre.size(), 2u);
  EXPECT_GT(groups.centre[0], 0.8f);
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      const size_t at = static_cast<size_t>(y) * pixels.width + x;
      if (pixels.object[at] < 0.5f) {
        EXPECT_EQ(groups.group[at], -1);
      } else {
        EXPECT_EQ(groups.group[at], x <= 29 ? 0 : 1) << x << " " << y;
      }
    }
  }
}

// A long object with several peaks of heat, whose offsets are too short by half, is one; a disc
// that touches it stays another.
TEST(GroupPixels, JoinsThePartsOfOneObject) {
  DetectedPixels pixels;
  pixels.width = 120;
  pixels.height = 40;
  const Eigen::Vector2f bar(40.0f, 20.0f), disc(88.0f, 20.0f);
  const auto is_bar = [&](int x, int y) { return x >= 5 && x <= 75 && y >= 15 && y <= 25; };
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      const Eigen::Vector2f at(x, y);
      const bool of_disc = (at - disc).norm() <= 12.0f;
      pixels.object.push_back(is_bar(x, y) || of_disc ? 0.9f : 0.1f);
      float heat = std::exp(-0.05f * (at - disc).squaredNorm());
      for (const float peak : {12.0f, 26.0f, 40.0f, 54.0f, 68.0f}) {
        heat = std::max(
            heat, 0.8f * std::exp(-0.05f * (at - Eigen::Vector2f(peak, 20.0f)).squaredNorm()));
      }
      pixels.centre.push_back(heat);
      pixels.offset.push_back(0.5f * ((of_disc ? disc : bar) - at));
    }
  }
  const PixelGroups groups = GroupPixels(pixels);
  ASSERT_EQ(groups.centre.size(), 2u);
  const auto group = [&](int x, int y) {
    return groups.group[static_cast<size_t>(y) * pixels.width + x];
  };
  for (int x = 7; x <= 73; ++x) EXPECT_EQ(group(x, 20), group(7, 20)) << x;
  for (int x = 78; x <= 98; ++x) EXPECT_EQ(group(x, 20), group(88, 20)) << x;
  EXPECT_NE(group(7, 20), group(88, 20));
}

TEST(GroupPixels, LeavesOutSpecks) {
  DetectedPixels pixels;
  pixels.width = pixels.height = 20;
  pixels.object.assign(400, 0.0f);
  pixels.centre.assign(400, 0.0f);
  pixels.offset.assign(400, Eigen::Vector2f::Zero());
  pixels.object[5 * 20 + 5] = 1.0f;  // one pixel
  pixels.centre[5 * 20 + 5] = 1.0f;
  EXPECT_TRUE(GroupPixels(pixels).centre.empty());
  // Pixels without any peak belong to no object.
  pixels.object.assign(400, 1.0f);
  pixels.centre.assign(400, 0.0f);
  const PixelGroups groups = GroupPixels(pixels);
  EXPECT_TRUE(groups.centre.empty());
  for (const int group : groups.group) EXPECT_EQ(group, -1);
}

}  // namespace
}  // namespace simwright::twin
