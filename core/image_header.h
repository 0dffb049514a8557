#pragma once

#include <cstdint>
#include <string_view>

namespace simwright::core {

enum class ImageFormat {
  kUnknown,
  kPng,
  kJpeg,
  kWebp,
  kAnimatedWebp,
  kGif,
  kTiff,
  kBmp,
  kPnm,
  kOther
};

// The format and size that an image file states, read without decoding.
struct ImageHeader {
  ImageFormat format = ImageFormat::kUnknown;
  std::int64_t width = 0;  // 0 where the header was not understood
  std::int64_t height = 0;
  bool truncated = false;  // the format's end marker is missing (PNG, JPEG)
};

// Reads magic bytes and sizes. Never throws and never reads beyond `bytes`.
ImageHeader ReadImageHeader(std::string_view bytes);

}  // namespace simwright::core
