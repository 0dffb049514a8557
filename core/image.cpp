#include "core/image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include <libexif/exif-data.h>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/animated_image.h"
#include "core/error.h"
#include "core/files.h"
#include "core/foreign_content.h"
#include "core/image_header.h"

namespace simwright::core {
namespace {

cv::Mat AsMat(const Image& image) {
  return cv::Mat(image.height, image.width, CV_8UC(image.channels),
                 const_cast<std::uint8_t*>(image.pixels.data()));
}

Image FromMat(const cv::Mat& mat) {
  Image image(mat.cols, mat.rows, mat.channels());
  for (int y = 0; y < mat.rows; ++y) {
    std::memcpy(image.At(0, y), mat.ptr(y), static_cast<size_t>(mat.cols) * mat.channels());
  }
  return image;
}

// Converts 16-bit and float images to 8 bits over their full range.
cv::Mat ToEightBit(const cv::Mat& mat) {
  if (mat.depth() == CV_8U) return mat;
  double scale = 1.0;
  if (mat.depth() == CV_16U) scale = 1.0 / 257.0;
  if (mat.depth() == CV_32F || mat.depth() == CV_64F) scale = 255.0;
  cv::Mat eight_bit;
  mat.convertTo(eight_bit, CV_8U, scale);
  return eight_bit;
}

cv::Mat ToRgbOrder(const cv::Mat& mat) {
  cv::Mat result;
  switch (mat.channels()) {
    case 1:
      return mat;
    case 2: {  // grey and alpha, possible from OpenCV's PNG reader
      cv::Mat planes[2];
      cv::split(mat, planes);
      cv::merge(std::vector<cv::Mat>{planes[0], planes[0], planes[0], planes[1]}, result);
      return result;
    }
    case 3:
      cv::cvtColor(mat, result, cv::COLOR_BGR2RGB);
      return result;
    default:
      cv::cvtColor(mat, result, cv::COLOR_BGRA2RGBA);
      return result;
  }
}

Image DecodeStill(std::string_view bytes, ImageFormat format, const std::string& where) {
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  // IMREAD_COLOR honours the EXIF orientation and converts CMYK; alpha needs UNCHANGED.
  const int flags = format == ImageFormat::kJpeg ? cv::IMREAD_COLOR : cv::IMREAD_UNCHANGED;
  // The error below replaces the messages that OpenCV's readers log for a damaged file.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  cv::Mat decoded;
  try {
    decoded = cv::imdecode(raw, flags);
  } catch (const cv::Exception&) {
    decoded.release();
  }
  if (decoded.empty()) {
    throw Error("the image cannot be decoded: it is damaged, truncated or of an unknown kind",
                where, "save it again as PNG or JPEG");
  }
  return FromMat(ToRgbOrder(ToEightBit(decoded)));
}

}  // namespace

Image DecodeImage(std::string_view bytes, const std::string& where,
                  const ImageReadOptions& options) {
  if (bytes.empty()) throw Error("the image file is empty", where);
  if (bytes.size() > static_cast<size_t>(INT32_MAX)) {
    throw Error("the image file is larger than 2 GiB", where);
  }
  const ImageHeader header = ReadImageHeader(bytes);
  std::optional<ForeignContent> foreign = FindForeignContent(bytes);
  if (!foreign) foreign = FindUnsupportedImageFormat(bytes);
  if (foreign) throw Error(foreign->what, where, foreign->remedy);
  if (header.format == ImageFormat::kUnknown) {
    throw Error("this is not a readable image", where,
                "use PNG, JPEG, WebP, TIFF, BMP, GIF or PNM");
  }
  if (header.width > 0 && header.height > 0 && header.width > options.max_pixels / header.height) {
    throw Error(
        "the image claims " + std::to_string(header.width) + " x " + std::to_string(header.height) +
            " pixels",
        where,
        "scale it down below " + std::to_string(options.max_pixels / 1'000'000) + " megapixels");
  }
  if (header.truncated) {
    throw Error("the image is truncated: its end is missing", where, "copy or export it again");
  }
  Image image;
  if (header.format == ImageFormat::kGif) {
    image = DecodeFirstGifFrame(bytes, where);
  } else if (header.format == ImageFormat::kAnimatedWebp) {
    image = DecodeFirstWebpFrame(bytes, where);
  } else {
    image = DecodeStill(bytes, header.format, where);
  }
  const int longer = std::max(image.width, image.height);
  if (options.max_side > 0 && longer > options.max_side) {
    const double scale = static_cast<double>(options.max_side) / longer;
    image = Resize(image, std::max(1, static_cast<int>(std::lround(image.width * scale))),
                   std::max(1, static_cast<int>(std::lround(image.height * scale))));
  }
  return image;
}

Image ReadImage(const std::filesystem::path& path, const ImageReadOptions& options) {
  return DecodeImage(ReadFile(path, 1ull << 30), path.string(), options);
}

std::string EncodePng(const Image& image) {
  // A separate Mat, since AsMat shares the caller's pixels.
  cv::Mat mat = AsMat(image);
  if (image.channels == 3) cv::cvtColor(AsMat(image), mat = cv::Mat(), cv::COLOR_RGB2BGR);
  if (image.channels == 4) cv::cvtColor(AsMat(image), mat = cv::Mat(), cv::COLOR_RGBA2BGRA);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", mat, bytes, {cv::IMWRITE_PNG_COMPRESSION, 6});
  return {bytes.begin(), bytes.end()};
}

void WritePng(const std::filesystem::path& path, const Image& image) {
  WriteFile(path, EncodePng(image));
}

std::string EncodeJpeg(const Image& image, int quality) {
  cv::Mat mat = AsMat(image);
  if (image.channels == 3) cv::cvtColor(AsMat(image), mat = cv::Mat(), cv::COLOR_RGB2BGR);
  if (image.channels == 4) cv::cvtColor(AsMat(image), mat = cv::Mat(), cv::COLOR_RGBA2BGR);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", mat, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return {bytes.begin(), bytes.end()};
}

double ExifFocalLength35mm(std::string_view bytes) {
  ExifData* data = exif_data_new_from_data(reinterpret_cast<const unsigned char*>(bytes.data()),
                                           static_cast<unsigned int>(bytes.size()));
  if (data == nullptr) return 0.0;
  const ExifEntry* entry =
      exif_content_get_entry(data->ifd[EXIF_IFD_EXIF], EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM);
  double focal = 0.0;
  if (entry != nullptr && entry->format == EXIF_FORMAT_SHORT && entry->components == 1) {
    focal = exif_get_short(entry->data, exif_data_get_byte_order(data));
  }
  exif_data_unref(data);
  return focal;
}

Image Resize(const Image& image, int width, int height) {
  if (image.empty() || width <= 0 || height <= 0) throw Error("cannot resize an empty image");
  if (width == image.width && height == image.height) return image;
  cv::Mat result;
  const bool shrinks = width <= image.width && height <= image.height;
  cv::resize(AsMat(image), result, cv::Size(width, height), 0.0, 0.0,
             shrinks ? cv::INTER_AREA : cv::INTER_CUBIC);
  return FromMat(result);
}

Image ContactSheet(const std::vector<Image>& pictures, int columns) {
  if (pictures.empty() || columns < 1) throw Error("a contact sheet needs at least one image");
  int cell_width = 0, cell_height = 0;
  for (const Image& picture : pictures) {
    cell_width = std::max(cell_width, picture.width);
    cell_height = std::max(cell_height, picture.height);
  }
  const int count = static_cast<int>(pictures.size());
  const int used_columns = std::min(columns, count);
  const int rows = (count + columns - 1) / columns;
  Image sheet(used_columns * cell_width, rows * cell_height, 3, 255);
  for (int i = 0; i < count; ++i) {
    const Image& picture = pictures[i];
    const int left = (i % columns) * cell_width + (cell_width - picture.width) / 2;
    const int top = (i / columns) * cell_height + (cell_height - picture.height) / 2;
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const std::uint8_t* from = picture.At(x, y);
        std::uint8_t* to = sheet.At(left + x, top + y);
        const int alpha = picture.channels == 4 ? from[3] : 255;
        for (int c = 0; c < 3; ++c) {
          const int value = from[picture.channels == 1 ? 0 : c];
          to[c] = static_cast<std::uint8_t>((value * alpha + 255 * (255 - alpha)) / 255);
        }
      }
    }
  }
  return sheet;
}

}  // namespace simwright::core
