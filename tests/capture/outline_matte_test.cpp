#include "capture/outline_matte.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/error.h"

namespace simwright::capture {
namespace {

constexpr int kSide = 240;            // pixels of the picture
constexpr double kDiscRadius = 60.3;  // pixels

// The share of a pixel that a disc about the picture's middle covers.
double DiscShare(int x, int y, double radius) {
  double share = 0.0;
  for (int k = 0; k < 64; ++k) {
    const double px = x + (k % 8 + 0.5) / 8 - 0.5 * kSide, py = y + (k / 8 + 0.5) / 8 - 0.5 * kSide;
    share += px * px + py * py < radius * radius ? 1.0 / 64 : 0.0;
  }
  return share;
}

struct DiscOnMat {
  core::Image photo = core::Image(kSide, kSide, 3);
  MatEvidence evidence;
  core::FloatImage truth = core::FloatImage(kSide, kSide, 1), mask = truth;
};

// A disc on a chequered mat with a soft shadow beside it; its mask is `excess` pixels too large.
DiscOnMat MakeDisc(double excess) {
  DiscOnMat disc;
  disc.evidence.difference = core::FloatImage(kSide, kSide, 1);
  disc.evidence.expected = core::Image(kSide, kSide, 3);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 2.0);
  const double colors[3] = {170.0, 80.0, 60.0};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double mat = (x / 30 + y / 30) % 2 == 0 ? 40.0 : 220.0;
      const double shadow = 1.0 - 0.4 * std::exp(-std::pow((x - 0.8 * kSide) / 30.0, 2));
      const double share = DiscShare(x, y, kDiscRadius);
      *disc.truth.At(x, y) = static_cast<float>(share);
      *disc.mask.At(x, y) = DiscShare(x, y, kDiscRadius + excess) >= 0.5 ? 1.0f : 0.0f;
      for (int c = 0; c < 3; ++c) {
        disc.evidence.expected.At(x, y)[c] = static_cast<std::uint8_t>(mat);
        const double value = share * colors[c] + (1.0 - share) * shadow * mat + noise(random);
        disc.photo.At(x, y)[c] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
      }
    }
  }
  return disc;
}

// The mean distance of the opacity's outline outside the disc's, pixels.
double OutlineExcess(const DiscOnMat& disc, const core::FloatImage& opacity) {
  double sum = 0.0;
  for (std::size_t i = 0; i < opacity.values.size(); ++i) {
    sum += opacity.values[i] - disc.truth.values[i];
  }
  return sum / (2.0 * std::numbers::pi * kDiscRadius);
}

TEST(OutlineMatte, CorrectsAMaskThatIsTooLargeOrTooSmall) {
  for (const double excess : {-2.0, 0.0, 2.0}) {
    const DiscOnMat disc = MakeDisc(excess);
    EXPECT_NEAR(OutlineExcess(disc, disc.mask), excess, 0.1);
    const core::FloatImage opacity = MatteOnMat(disc.photo, disc.evidence, disc.mask);
    EXPECT_LT(std::abs(OutlineExcess(disc, opacity)), 0.25) << excess;
    double worst = 0.0;
    for (std::size_t i = 0; i < opacity.values.size(); ++i) {
      worst = std::max<double>(worst, std::abs(opacity.values[i] - disc.truth.values[i]));
    }
    EXPECT_LT(worst, 0.7) << excess;
  }
}

TEST(OutlineMatte, KeepsTheMaskBesideTheMat) {
  DiscOnMat disc = MakeDisc(2.0);
  disc.evidence.difference = core::FloatImage(kSide, kSide, 1, -1.0f);
  const core::FloatImage opacity = MatteOnMat(disc.photo, disc.evidence, disc.mask);
  EXPECT_NEAR(OutlineExcess(disc, opacity), 2.0, 0.1);
  disc.evidence.expected = core::Image(3, 3, 3);
  EXPECT_THROW(MatteOnMat(disc.photo, disc.evidence, disc.mask), core::Error);
}

}  // namespace
}  // namespace simwright::capture
