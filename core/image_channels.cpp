#include "core/image_channels.h"

#include <cstddef>

namespace simwright::core {

Image InRgb(const Image& image) {
  if (image.channels == 3) return image;
  const auto channels = static_cast<std::size_t>(image.channels);
  Image rgb(image.width, image.height, 3);
  for (std::size_t i = 0; i < rgb.pixels.size() / 3; ++i) {
    const std::uint8_t* from = &image.pixels[channels * i];
    const int alpha = channels == 4 ? from[3] : 255;
    for (std::size_t c = 0; c < 3; ++c) {
      const int value = channels == 4 ? from[c] : from[0];
      rgb.pixels[3 * i + c] =
          static_cast<std::uint8_t>((value * alpha + 255 * (255 - alpha)) / 255);
    }
  }
  return rgb;
}

}  // namespace simwright::core
