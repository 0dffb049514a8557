#include "twin/photo_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/error.h"
#include "core/image_channels.h"
#include "tests/twin/rendered_table.h"

namespace simwright::twin {
namespace {

core::Image Dimmed(core::Image photo, double factor) {
  for (std::uint8_t& value : photo.pixels) {
    value = static_cast<std::uint8_t>(std::min(255.0, factor * value));
  }
  return photo;
}

TEST(CheckTablePhoto, RefusesTheNight) {
  const RenderedTable table =
      RenderKinds({{"mug", 1'000'000'011, 0.0, 0.9, 0.0}}, {0.65, 0.0, 1.1, 0.7});
  EXPECT_TRUE(CheckTablePhoto(table.picture.color, "photo.jpg").empty());
  const core::Findings dusk = CheckTablePhoto(Dimmed(table.picture.color, 0.2), "photo.jpg");
  ASSERT_EQ(dusk.size(), 1u);
  EXPECT_EQ(dusk[0].code, "twin-dark");
  EXPECT_LT(dusk[0].figure, 45.0);
  try {
    CheckTablePhoto(Dimmed(table.picture.color, 0.04), "photo.jpg");
    ADD_FAILURE() << "a black photo was taken";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("photo.jpg: the photo is too dark"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(CheckTablePhoto(core::Image(100, 80, 3, 200), "plain.png"), core::Error);
  core::Image lit = table.picture.color;
  std::fill(lit.pixels.begin(), lit.pixels.begin() + static_cast<long>(lit.pixels.size()) * 6 / 10,
            std::uint8_t{255});
  const core::Findings glare = CheckTablePhoto(lit, "photo.jpg");
  ASSERT_EQ(glare.size(), 1u);
  EXPECT_EQ(glare[0].code, "twin-overexposed");
}

TEST(InRgb, LaysTransparencyOverWhite) {
  core::Image grey(2, 1, 1);
  grey.pixels = {10, 250};
  EXPECT_EQ(core::InRgb(grey).pixels, (std::vector<std::uint8_t>{10, 10, 10, 250, 250, 250}));
  core::Image clear(2, 1, 4);
  clear.pixels = {10, 20, 30, 255, 10, 20, 30, 0};
  EXPECT_EQ(core::InRgb(clear).pixels, (std::vector<std::uint8_t>{10, 20, 30, 255, 255, 255}));
  EXPECT_EQ(core::InRgb(core::InRgb(clear)).pixels, core::InRgb(clear).pixels);
}

}  // namespace
}  // namespace simwright::twin
