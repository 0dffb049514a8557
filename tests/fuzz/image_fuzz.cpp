// Pictures from anywhere: core::Error or a picture, nothing else.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/error.h"
#include "core/image.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  simwright::core::ImageReadOptions options;
  options.max_pixels = 1'000'000;
  try {
    const simwright::core::Image image = simwright::core::DecodeImage(bytes, "input", options);
    const auto expected = static_cast<std::size_t>(image.width) * image.height * image.channels;
    if (image.empty() || image.pixels.size() != expected) std::abort();
  } catch (const simwright::core::Error&) {
  }
  if (!(simwright::core::ExifFocalLength35mm(bytes) >= 0.0)) std::abort();
  return 0;
}
