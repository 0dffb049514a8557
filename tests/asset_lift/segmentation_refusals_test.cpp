// The photos that segmentation rejects: an empty table, clear glass, a second object, an object of
// a few pixels. Each image is synthetic; the same image with one opaque object is accepted.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "asset_lift/segmentation/segmentation.h"
#include "core/error.h"
#include "core/random.h"
#include "tests/sanitized.h"

namespace simwright::asset_lift {
namespace {

constexpr int kWidth = 400, kHeight = 300;

using Color = std::array<double, 3>;

core::Image Drawn(const std::function<Color(double x, double y)>& color, double noise) {
  core::Image photo(kWidth, kHeight, 3);
  core::Rng rng(1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Color at = color(x, y);
      const double grain = noise * core::Uniform(rng, -1.0, 1.0);
      for (int c = 0; c < 3; ++c) {
        photo.At(x, y)[c] = static_cast<uint8_t>(std::clamp(at[c] + grain, 0.0, 255.0));
      }
    }
  }
  return photo;
}

double Squared(double x, double y, double to_x, double to_y) {
  return (x - to_x) * (x - to_x) + (y - to_y) * (y - to_y);
}

Color Plain(double x, double y) {
  const double grey = 200.0 - 40.0 * Squared(x, y, 200, 150) / (250.0 * 250.0);
  return {grey, grey, grey};
}

Color Spot(double x, double y) {
  const double grey = 120.0 + 100.0 * std::exp(-Squared(x, y, 220, 130) / (2.0 * 55.0 * 55.0));
  return {grey, 0.97 * grey, 0.9 * grey};
}

Color WallAndTable(double x, double y) {
  if (y < 160) return {210, 215, 220};
  const double grain = 140.0 + 20.0 * std::sin(y / 6.0 + 3.0 * std::sin(x / 60.0));
  return {1.1 * grain, 0.8 * grain, 0.55 * grain};
}

// A clear tumbler: faint lines and a highlight over the background.
Color Glass(double x, double y) {
  const Color behind = {222, 224, 226};
  const bool inside = x > 155 && x < 245 && y > 70 && y < 250;
  const bool line = inside && (x < 157 || x > 243 || y < 72 || y > 247);
  if (line) return {196, 199, 202};
  if (inside && x > 165 && x < 172) return {236, 237, 238};
  return behind;
}

Color Ball(double x, double y, double to_x, double to_y, double radius, const Color& behind) {
  return Squared(x, y, to_x, to_y) < radius * radius ? Color{190, 50, 40} : behind;
}

// Returns the error message; empty if an object was segmented.
std::string Refusal(const core::Image& photo) {
  try {
    SegmentObject(photo, {});
    return "";
  } catch (const core::Error& error) {
    return error.what();
  }
}

TEST(SegmentationRefusals, AnEmptyTableIsNoObject) {
  SKIP_UNDER_SANITIZERS();
  for (const auto& table : {Plain, Spot, WallAndTable}) {
    const std::string refusal = Refusal(Drawn(table, 4.0));
    EXPECT_NE(refusal.find("stands out"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("--mask"), std::string::npos) << refusal;
    const auto with_ball = [&](double x, double y) {
      return Ball(x, y, 200, 170, 60, table(x, y));
    };
    const Matte matte = SegmentObject(Drawn(with_ball, 4.0), {});
    EXPECT_NEAR(matte.area, M_PI * 60 * 60 / (kWidth * kHeight), 0.02);
  }
}

TEST(SegmentationRefusals, ClearGlassIsNotCutOut) {
  const std::string refusal = Refusal(Drawn(Glass, 2.0));
  EXPECT_NE(refusal.find("stands out"), std::string::npos) << refusal;
}

TEST(SegmentationRefusals, ASmallerSecondObjectIsOneAllTheSame) {
  const auto two = [](double second) {
    return [second](double x, double y) {
      return Ball(x, y, 320, 190, second, Ball(x, y, 130, 150, 70, {225, 225, 225}));
    };
  };
  EXPECT_NE(Refusal(Drawn(two(32), 3.0)).find("two objects"), std::string::npos);
  EXPECT_NE(Refusal(Drawn(two(60), 3.0)).find("two objects"), std::string::npos);
  EXPECT_EQ(Refusal(Drawn(two(6), 3.0)), "");  // a speck
  // A shadow as large beside it has no edge.
  const auto shadow = [](double x, double y) {
    const double grey = 225.0 - 45.0 * std::exp(-Squared(x, y, 320, 190) / (2.0 * 26.0 * 26.0));
    return Ball(x, y, 130, 150, 70, {grey, grey, grey});
  };
  EXPECT_EQ(Refusal(Drawn(shadow, 3.0)), "");
}

TEST(SegmentationRefusals, AnObjectOfAFewPixelsIsTooSmall) {
  const auto small = [](int side, double radius) {
    core::Image photo(side, side, 4);
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const bool in = Squared(x + 0.5, y + 0.5, 0.5 * side, 0.5 * side) < radius * radius;
        photo.At(x, y)[0] = 200;
        photo.At(x, y)[3] = in ? 255 : 0;
      }
    }
    return photo;
  };
  EXPECT_NE(Refusal(small(40, 10)).find("only 20 x 20 pixels"), std::string::npos);
  EXPECT_NE(Refusal(small(300, 13)).find("only 26 x 26 pixels"), std::string::npos);
  EXPECT_EQ(Refusal(small(40, 18)), "");
}

}  // namespace
}  // namespace simwright::asset_lift
