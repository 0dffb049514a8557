#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace simwright::core {

// 8-bit picture, channels interleaved, rows from the top. 1 (grey), 3 (RGB) or 4 (RGBA) channels,
// sRGB.
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
  // Refuses more than this by the header, before any memory is taken. A 200-megapixel phone
  // photo still fits.
  std::int64_t max_pixels = 220'000'000;
  // Larger pictures are scaled down (area average) so that the longer side fits; 0 keeps them.
  int max_side = 0;
};

// Decodes PNG, JPEG (grey, YCbCr, CMYK), WebP, TIFF, BMP, GIF, PNM and what else OpenCV reads.
// 16-bit and float pictures become 8-bit; of an animated or paged one the first frame is taken;
// the EXIF orientation is applied. `where` is named in errors.
// Throws core::Error: empty, unknown, truncated or too large.
Image DecodeImage(std::string_view bytes, const std::string& where,
                  const ImageReadOptions& options = {});
Image ReadImage(const std::filesystem::path& path, const ImageReadOptions& options = {});

// PNG with fixed settings: the same pixels give the same bytes.
std::string EncodePng(const Image& image);
void WritePng(const std::filesystem::path& path, const Image& image);
// JPEG at `quality` 1..100, for textures that came as JPEG.
std::string EncodeJpeg(const Image& image, int quality);

// Width / 35 mm-equivalent focal length as EXIF tells it, in mm on a 36 mm wide frame; 0 where
// the file says nothing. Reads JPEG, TIFF and PNG through the EXIF block.
double ExifFocalLength35mm(std::string_view bytes);

// Area-averaged (down) or bicubic (up) copy of the given size. Requires a non-empty image.
Image Resize(const Image& image, int width, int height);

// Pictures side by side in `columns`, on white, each cell as large as the largest picture.
Image ContactSheet(const std::vector<Image>& pictures, int columns);

}  // namespace simwright::core
