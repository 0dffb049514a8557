#include "texture/endpoints/endpoint_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/image_channels.h"

namespace simwright::texture {
namespace {

constexpr double kAspectTolerance = 0.02;  // relative difference of aspect ratios
constexpr int kFarthestDepth = 64;         // of the inverse depth picture

Canvas PictureAlone(const ImageRequest& request) {
  Canvas canvas;
  const bool view = !request.render.empty();
  canvas.picture_width = view ? request.render.width : request.width;
  canvas.picture_height = view ? request.render.height : request.height;
  return canvas;
}

void CentrePicture(Canvas* canvas) {
  canvas->left = (canvas->width - canvas->picture_width) / 2;
  canvas->top = (canvas->height - canvas->picture_height) / 2;
}

core::Image CroppedTo(const core::Image& image, int left, int top, int width, int height) {
  core::Image cropped(width, height, image.channels);
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* from = image.At(left, top + y);
    std::copy(from, from + static_cast<std::size_t>(width) * image.channels, cropped.At(0, y));
  }
  return cropped;
}

bool HasOneColour(const core::Image& image) {
  for (int c = 0; c < image.channels; ++c) {
    int low = 255, high = 0;
    for (std::size_t i = static_cast<std::size_t>(c); i < image.pixels.size();
         i += static_cast<std::size_t>(image.channels)) {
      low = std::min<int>(low, image.pixels[i]);
      high = std::max<int>(high, image.pixels[i]);
    }
    if (high - low > 2) return false;
  }
  return true;
}

std::string SizeText(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

// Crops the centre of `picture` to an aspect ratio.
core::Image CroppedToAspect(const core::Image& picture, double aspect) {
  int width = picture.width, height = picture.height;
  if (width > height * aspect) {
    width = std::clamp(static_cast<int>(std::lround(height * aspect)), 1, picture.width);
  } else {
    height = std::clamp(static_cast<int>(std::lround(width / aspect)), 1, picture.height);
  }
  return CroppedTo(picture, (picture.width - width) / 2, (picture.height - height) / 2, width,
                   height);
}

}  // namespace

Canvas CanvasOf(const ImageRequest& request, int multiple) {
  Canvas canvas = PictureAlone(request);
  const auto round_up = [&](int side) { return (side + multiple - 1) / multiple * multiple; };
  canvas.width = round_up(canvas.picture_width);
  canvas.height = round_up(canvas.picture_height);
  CentrePicture(&canvas);
  return canvas;
}

Canvas CanvasOfAspect(const ImageRequest& request, int aspect_width, int aspect_height) {
  Canvas canvas = PictureAlone(request);
  const double aspect = static_cast<double>(aspect_width) / aspect_height;
  canvas.width =
      std::max(canvas.picture_width, static_cast<int>(std::lround(canvas.picture_height * aspect)));
  canvas.height =
      std::max(canvas.picture_height, static_cast<int>(std::lround(canvas.picture_width / aspect)));
  CentrePicture(&canvas);
  return canvas;
}

core::Image PaddedRender(const ImageRequest& request, const Canvas& canvas) {
  core::Image padded(canvas.width, canvas.height, 3);
  for (int y = 0; y < canvas.height; ++y) {
    for (int x = 0; x < canvas.width; ++x) {
      const std::uint8_t* from =
          request.render.At(std::clamp(x - canvas.left, 0, canvas.picture_width - 1),
                            std::clamp(y - canvas.top, 0, canvas.picture_height - 1));
      std::copy(from, from + 3, padded.At(x, y));
    }
  }
  return padded;
}

core::Image InpaintingMask(const ImageRequest& request, const Canvas& canvas) {
  core::Image mask(canvas.width, canvas.height, 1);
  for (int y = 0; y < canvas.picture_height; ++y) {
    for (int x = 0; x < canvas.picture_width; ++x) {
      const bool repaint = *request.trimap.At(x, y) != kTrimapKeep;
      *mask.At(x + canvas.left, y + canvas.top) = repaint ? 255 : 0;
    }
  }
  return mask;
}

core::Image InverseDepthPicture(const ImageRequest& request, const Canvas& canvas) {
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0.0f;
  for (const float depth : request.depth.values) {
    if (!(depth > 0.0f) || !std::isfinite(depth)) continue;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  core::Image picture(canvas.width, canvas.height, 3);
  const float span = farthest > nearest ? 1.0f / nearest - 1.0f / farthest : 0.0f;
  for (int y = 0; y < canvas.picture_height; ++y) {
    for (int x = 0; x < canvas.picture_width; ++x) {
      const float depth = *request.depth.At(x, y);
      if (!(depth > 0.0f) || !std::isfinite(depth)) continue;
      const float share = span > 0.0f ? (1.0f / depth - 1.0f / farthest) / span : 1.0f;
      const float value = static_cast<float>(kFarthestDepth) + share * (255 - kFarthestDepth);
      std::uint8_t* to = picture.At(x + canvas.left, y + canvas.top);
      std::fill(to, to + 3, static_cast<std::uint8_t>(std::lround(value)));
    }
  }
  return picture;
}

core::Image AnsweredPicture(const std::string& bytes, const ImageRequest& request,
                            const Canvas& canvas, EndpointConnection* connection) {
  core::Image picture;
  try {
    core::ImageReadOptions limits;
    limits.max_pixels = connection->options().max_picture_pixels;
    picture = core::InRgb(core::DecodeImage(bytes, "the picture", limits));
  } catch (const core::Error& error) {
    const std::string content = DescribeAnswer(bytes);
    const bool binary = content == "of an unknown binary format";
    connection->Fail(
        binary ? std::string("its answer is no usable picture: ") + error.what()
               : "its answer is " + connection->Clean(content, 200) + ", expected a picture",
        "check the address and --dialect");
  }
  if (HasOneColour(picture)) {
    connection->Fail("its picture has one colour only, as those that a content filter blanks",
                     "word the prompt differently, or see the server's log for a numerical fault");
  }
  const double wanted = static_cast<double>(canvas.width) / canvas.height;
  const double given = static_cast<double>(picture.width) / picture.height;
  const std::string sizes = SizeText(picture.width, picture.height) + " pixels, not the " +
                            SizeText(canvas.width, canvas.height) + " that were asked for";
  if (std::abs(given / wanted - 1.0) > kAspectTolerance) {
    if (!request.render.empty()) {
      connection->Fail("its picture has " + sizes + ", so that it does not fit the view",
                       "set the server to return the size of the request");
    }
    connection->Report("image-cropped", core::Severity::kWarning,
                       "the picture had " + sizes + "; its centre was kept");
    picture = CroppedToAspect(picture, wanted);
  } else if (picture.width != canvas.width || picture.height != canvas.height) {
    connection->Report("image-resized", core::Severity::kInfo,
                       "the picture had " + sizes + "; it was resized");
  }
  if (picture.width != canvas.width || picture.height != canvas.height) {
    picture = core::Resize(picture, canvas.width, canvas.height);
  }
  if (!canvas.padded()) return picture;
  return CroppedTo(picture, canvas.left, canvas.top, canvas.picture_width, canvas.picture_height);
}

}  // namespace simwright::texture
