#include "core/image.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"

namespace simwright::core {
namespace {

const std::string kExamples = SIMWRIGHT_SOURCE_DIR "/examples";

Image Checker(int width, int height, int channels) {
  Image image(width, height, channels);
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<uint8_t>(37 * i);
  return image;
}

TEST(Image, PngKeepsEveryPixel) {
  for (int channels : {1, 3, 4}) {
    const Image image = Checker(17, 9, channels);
    const Image back = DecodeImage(EncodePng(image), "test");
    EXPECT_EQ(back.channels, channels);
    EXPECT_EQ(back.pixels, image.pixels);
  }
}

TEST(Image, RefusesWhatIsNoPicture) {
  EXPECT_THROW(DecodeImage("", "empty.png"), Error);
  EXPECT_THROW(DecodeImage("these are words", "words.png"), Error);
}

TEST(Image, RefusesEveryTruncation) {
  const std::string png = EncodePng(Checker(40, 30, 3));
  const std::string jpeg = EncodeJpeg(Checker(40, 30, 3), 90);
  for (const std::string& bytes : {png, jpeg}) {
    for (size_t length = 0; length + 3 < bytes.size(); length += 7) {
      EXPECT_THROW(DecodeImage(bytes.substr(0, length), "cut"), Error) << length;
    }
  }
}

TEST(Image, RefusesHugeSizeByItsHeader) {
  std::string png = EncodePng(Checker(8, 8, 3));
  // 100000 x 100000 pixels in IHDR: refused before memory is allocated.
  const std::string side("\x00\x01\x86\xA0", 4);
  png.replace(16, 4, side);
  png.replace(20, 4, side);
  try {
    DecodeImage(png, "huge.png");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("100000 x 100000"), std::string::npos);
  }
}

TEST(Image, ScalesDownOnRequest) {
  ImageReadOptions options;
  options.max_side = 20;
  const Image small = DecodeImage(EncodePng(Checker(80, 40, 3)), "test", options);
  EXPECT_EQ(small.width, 20);
  EXPECT_EQ(small.height, 10);
}

}  // namespace
}  // namespace simwright::core
