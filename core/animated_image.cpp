#include "core/animated_image.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include <gif_lib.h>
#include <webp/demux.h>

#include "core/error.h"

namespace simwright::core {
namespace {

struct GifCloser {
  void operator()(GifFileType* gif) const { DGifCloseFile(gif, nullptr); }
};

[[noreturn]] void ThrowDamaged(const std::string& where) {
  throw Error("the image cannot be decoded: it is damaged or truncated", where,
              "save it again as PNG or JPEG");
}

int ReadFromView(GifFileType* gif, GifByteType* buffer, int count) {
  auto* rest = static_cast<std::string_view*>(gif->UserData);
  const size_t taken = std::min(static_cast<size_t>(std::max(0, count)), rest->size());
  std::memcpy(buffer, rest->data(), taken);
  rest->remove_prefix(taken);
  return static_cast<int>(taken);
}

// Reads records up to the first image; `transparent` receives the transparent index, or -1.
bool SeekFirstImage(GifFileType* gif, int* transparent) {
  *transparent = NO_TRANSPARENT_COLOR;
  for (;;) {
    GifRecordType type;
    if (DGifGetRecordType(gif, &type) == GIF_ERROR) return false;
    if (type == IMAGE_DESC_RECORD_TYPE) return DGifGetImageDesc(gif) != GIF_ERROR;
    if (type != EXTENSION_RECORD_TYPE) return false;
    int code = 0;
    GifByteType* block = nullptr;
    if (DGifGetExtension(gif, &code, &block) == GIF_ERROR) return false;
    while (block != nullptr) {
      GraphicsControlBlock control;
      if (code == GRAPHICS_EXT_FUNC_CODE &&
          DGifExtensionToGCB(block[0], block + 1, &control) == GIF_OK) {
        *transparent = control.TransparentColor;
      }
      if (DGifGetExtensionNext(gif, &block) == GIF_ERROR) return false;
    }
  }
}

}  // namespace

Image DecodeFirstGifFrame(std::string_view bytes, const std::string& where) {
  std::string_view rest = bytes;
  int code = 0;
  const std::unique_ptr<GifFileType, GifCloser> gif(DGifOpen(&rest, ReadFromView, &code));
  int transparent = NO_TRANSPARENT_COLOR;
  if (!gif || !SeekFirstImage(gif.get(), &transparent)) ThrowDamaged(where);
  const GifImageDesc& frame = gif->Image;
  const ColorMapObject* colors = frame.ColorMap ? frame.ColorMap : gif->SColorMap;
  if (colors == nullptr || frame.Width <= 0 || frame.Height <= 0 || gif->SWidth <= 0 ||
      gif->SHeight <= 0) {
    ThrowDamaged(where);
  }
  Image image(gif->SWidth, gif->SHeight, 4);
  std::vector<GifPixelType> line(static_cast<size_t>(frame.Width));
  // Interlaced rows come in four passes (GIF89a, appendix E).
  constexpr int kFirst[] = {0, 4, 2, 1}, kStep[] = {8, 8, 4, 2};
  for (int pass = 0; pass < (frame.Interlace ? 4 : 1); ++pass) {
    const int first = frame.Interlace ? kFirst[pass] : 0;
    const int step = frame.Interlace ? kStep[pass] : 1;
    for (int row = first; row < frame.Height; row += step) {
      if (DGifGetLine(gif.get(), line.data(), frame.Width) == GIF_ERROR) ThrowDamaged(where);
      const int y = frame.Top + row;
      for (int column = 0; column < frame.Width; ++column) {
        const int x = frame.Left + column;
        const int index = line[column];
        if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
        if (index == transparent || index >= colors->ColorCount) continue;
        const GifColorType& color = colors->Colors[index];
        std::uint8_t* pixel = image.At(x, y);
        pixel[0] = color.Red;
        pixel[1] = color.Green;
        pixel[2] = color.Blue;
        pixel[3] = 255;
      }
    }
  }
  return image;
}

Image DecodeFirstWebpFrame(std::string_view bytes, const std::string& where) {
  WebPAnimDecoderOptions options;
  WebPAnimDecoderOptionsInit(&options);
  options.color_mode = MODE_RGBA;
  const WebPData data{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  const std::unique_ptr<WebPAnimDecoder, decltype(&WebPAnimDecoderDelete)> decoder(
      WebPAnimDecoderNew(&data, &options), WebPAnimDecoderDelete);
  WebPAnimInfo info;
  std::uint8_t* frame = nullptr;
  int timestamp = 0;
  if (!decoder || !WebPAnimDecoderGetInfo(decoder.get(), &info) ||
      !WebPAnimDecoderGetNext(decoder.get(), &frame, &timestamp)) {
    ThrowDamaged(where);
  }
  Image image(static_cast<int>(info.canvas_width), static_cast<int>(info.canvas_height), 4);
  std::memcpy(image.pixels.data(), frame, image.pixels.size());
  return image;
}

}  // namespace simwright::core
