#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace simwright::core {

// An 8-bit sRGB image, channels interleaved, rows from the top, with 1 (grey), 3 (RGB) or 4 (RGBA)
// channels.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<std::uint8_t> pixels;  // (height x width x channels)

  Image() = default;
  Image(int w, int h, int c, std::uint8_t value = 0)
      : width(w), height(h), channels(c), pixels(static_cast<size_t>(w) * h * c, value) {}

  bool empty() const { return pixels.empty(); }
  std::uint8_t* At(int x, int y) {
    return &pixels[(static_cast<size_t>(y) * width + x) * channels];
  }
  const std::uint8_t* At(int x, int y) const {
    return &pixels[(static_cast<size_t>(y) * width + x) * channels];
  }
};

struct ImageReadOptions {
  // Larger images are refused from the header, before any memory is allocated. A 200-megapixel
  // phone photo still fits.
  std::int64_t max_pixels = 220'000'000;
  // Larger images are scaled down (area average) so that the longer side fits; 0 keeps their size.
  int max_side = 0;
};

// Decodes PNG, JPEG (grey, YCbCr, CMYK), WebP, TIFF, BMP, GIF, PNM and the other formats that
// OpenCV reads. 16-bit and float images become 8-bit, only the first frame or page is read, and the
// EXIF orientation is applied. Errors name `where`. Throws core::Error for an empty, unknown,
// truncated or too large image.
Image DecodeImage(std::string_view bytes, const std::string& where,
                  const ImageReadOptions& options = {});
Image ReadImage(const std::filesystem::path& path, const ImageReadOptions& options = {});

// Encodes a PNG with fixed settings: the same pixels give the same bytes.
std::string EncodePng(const Image& image);
void WritePng(const std::filesystem::path& path, const Image& image);
// Encodes a JPEG at `quality` 1..100, for textures that came as JPEG.
std::string EncodeJpeg(const Image& image, int quality);

// Returns the 35 mm-equivalent focal length from the EXIF block of a JPEG, TIFF or PNG, in mm for a
// 36 mm wide frame; 0 if the file has none.
double ExifFocalLength35mm(std::string_view bytes);

// Returns a copy of the given size, by area averaging (down) or bicubic interpolation (up).
// Requires a non-empty image.
Image Resize(const Image& image, int width, int height);

// Arranges images in `columns` on white; each cell has the size of the largest image.
Image ContactSheet(const std::vector<Image>& pictures, int columns);

}  // namespace simwright::core
