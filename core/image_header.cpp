#include "core/image_header.h"

#include <cstdlib>
#include <string>

namespace simwright::core {
namespace {

using Byte = unsigned char;

std::uint32_t BigEndian(std::string_view bytes, size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | static_cast<Byte>(bytes[at + i]);
  return value;
}

std::uint32_t LittleEndian(std::string_view bytes, size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = count - 1; i >= 0; --i) value = value << 8 | static_cast<Byte>(bytes[at + i]);
  return value;
}

// Reads a PNG header (PNG specification, 5.2 and 11.2.2): signature, then IHDR with width and
// height.
void ReadPng(std::string_view bytes, ImageHeader* header) {
  header->format = ImageFormat::kPng;
  header->truncated = bytes.find("IEND") == std::string_view::npos;
  if (bytes.size() < 24) return;
  header->width = BigEndian(bytes, 16, 4);
  header->height = BigEndian(bytes, 20, 4);
}

// Reads a JPEG header (ITU T.81, B.1.1.3): segments up to the first frame header (SOF0..15 except
// DHT, JPG and DAC).
void ReadJpeg(std::string_view bytes, ImageHeader* header) {
  header->format = ImageFormat::kJpeg;
  header->truncated = bytes.find("\xFF\xD9") == std::string_view::npos ||
                      bytes.rfind("\xFF\xD9") < bytes.rfind("\xFF\xDA");
  size_t at = 2;
  while (at + 9 < bytes.size()) {
    if (static_cast<Byte>(bytes[at]) != 0xFF) return;
    const Byte marker = static_cast<Byte>(bytes[at + 1]);
    if (marker == 0xFF) {
      ++at;
      continue;
    }
    if (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC) {
      header->height = BigEndian(bytes, at + 5, 2);
      header->width = BigEndian(bytes, at + 7, 2);
      return;
    }
    at += 2 + BigEndian(bytes, at + 2, 2);
  }
}

// Reads a WebP header (RIFF container): VP8X carries canvas size and the animation flag.
void ReadWebp(std::string_view bytes, ImageHeader* header) {
  header->format = ImageFormat::kWebp;
  if (bytes.size() < 30) return;
  header->truncated = bytes.size() < LittleEndian(bytes, 4, 4);
  if (bytes.substr(12, 4) == "VP8X") {
    header->width = 1 + LittleEndian(bytes, 24, 3);
    header->height = 1 + LittleEndian(bytes, 27, 3);
    if (static_cast<Byte>(bytes[20]) & 0x02) header->format = ImageFormat::kAnimatedWebp;
  }
}

// Reads a PNM header: "P5 width height maxval", with comments between.
void ReadPnm(std::string_view bytes, ImageHeader* header) {
  header->format = ImageFormat::kPnm;
  const std::string head(bytes.substr(2, 512));
  std::int64_t* const sizes[] = {&header->width, &header->height};
  size_t at = 0;
  for (std::int64_t* size : sizes) {
    for (;;) {
      at = head.find_first_not_of(" \t\r\n", at);
      if (at == std::string::npos) return;
      if (head[at] != '#') break;
      at = head.find('\n', at);
      if (at == std::string::npos) return;
    }
    char* end = nullptr;
    *size = std::strtoll(head.c_str() + at, &end, 10);
    at = static_cast<size_t>(end - head.c_str());
  }
}

void ReadTiff(std::string_view bytes, ImageHeader* header) {
  header->format = ImageFormat::kTiff;
  const bool little = bytes[0] == 'I';
  const auto number = [&](size_t at, int count) -> std::uint32_t {
    if (at + count > bytes.size()) return 0;
    return little ? LittleEndian(bytes, at, count) : BigEndian(bytes, at, count);
  };
  const size_t directory = number(4, 4);
  const std::uint32_t entries = number(directory, 2);
  for (std::uint32_t i = 0; i < entries; ++i) {
    const size_t entry = directory + 2 + 12 * static_cast<size_t>(i);
    if (entry + 12 > bytes.size()) return;
    const std::uint32_t tag = number(entry, 2);  // 256 width, 257 height; type 3 is 16 bits
    const std::uint32_t value = number(entry + 8, number(entry + 2, 2) == 3 ? 2 : 4);
    if (tag == 256) header->width = value;
    if (tag == 257) header->height = value;
  }
}

}  // namespace

ImageHeader ReadImageHeader(std::string_view bytes) {
  ImageHeader header;
  const auto starts = [&](std::string_view magic) {
    return bytes.substr(0, magic.size()) == magic;
  };
  if (starts("\x89PNG\r\n\x1a\n")) {
    ReadPng(bytes, &header);
  } else if (starts("\xFF\xD8\xFF")) {
    ReadJpeg(bytes, &header);
  } else if (starts("RIFF") && bytes.size() >= 16 && bytes.substr(8, 4) == "WEBP") {
    ReadWebp(bytes, &header);
  } else if ((starts("GIF87a") || starts("GIF89a")) && bytes.size() >= 10) {
    header.format = ImageFormat::kGif;
    header.width = LittleEndian(bytes, 6, 2);
    header.height = LittleEndian(bytes, 8, 2);
  } else if (bytes.size() >= 8 &&
             (starts(std::string_view("II*\0", 4)) || starts(std::string_view("MM\0*", 4)))) {
    ReadTiff(bytes, &header);
  } else if (starts("BM") && bytes.size() >= 26) {
    header.format = ImageFormat::kBmp;
    header.width =
        std::abs(static_cast<std::int64_t>(static_cast<std::int32_t>(LittleEndian(bytes, 18, 4))));
    header.height =
        std::abs(static_cast<std::int64_t>(static_cast<std::int32_t>(LittleEndian(bytes, 22, 4))));
  } else if (bytes.size() >= 8 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '7') {
    ReadPnm(bytes, &header);
  } else if (starts("\x76\x2f\x31\x01") || starts("#?RADIANCE") ||
             starts(std::string_view("\0\0\0\x0cjP  ", 8))) {
    header.format = ImageFormat::kOther;  // OpenEXR, Radiance HDR, JPEG 2000: OpenCV's own limits
  }
  return header;
}

}  // namespace simwright::core
