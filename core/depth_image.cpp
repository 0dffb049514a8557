#include "core/depth_image.h"

#include <cstdint>
#include <string>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/image_header.h"

namespace simwright::core {
namespace {

constexpr std::uint64_t kMostDepthBytes = 256u << 20;
constexpr std::int64_t kMostDepthPixels = 64'000'000;
constexpr char kDepthRemedy[] = "write it as a PNG with one channel of 16 bits";

}  // namespace

FloatImage ReadDepthImage(const std::filesystem::path& path, double unit) {
  const std::string bytes = ReadFile(path, kMostDepthBytes);
  const ImageHeader header = ReadImageHeader(bytes);
  if (header.format != ImageFormat::kPng && header.format != ImageFormat::kTiff) {
    throw Error("this is no depth image", path.string(), kDepthRemedy);
  }
  if (header.truncated) {
    throw Error("the depth image is truncated: its end is missing", path.string(),
                "copy or export it again");
  }
  if (header.height > 0 && header.width > kMostDepthPixels / header.height) {
    throw Error("the depth image has more than 64 megapixels", path.string(), "scale it down");
  }
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  cv::Mat decoded;
  try {
    decoded = cv::imdecode(raw, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    decoded.release();
  }
  if (decoded.empty()) throw Error("the depth image is damaged", path.string(), kDepthRemedy);
  if (decoded.depth() != CV_16U) {
    throw Error("the depth image must have 16 bits a pixel, unsigned", path.string(), kDepthRemedy);
  }
  if (decoded.channels() != 1) {
    throw Error("the depth image is in colour", path.string(), kDepthRemedy);
  }
  FloatImage depth(decoded.cols, decoded.rows, 1);
  for (int y = 0; y < decoded.rows; ++y) {
    const auto* row = decoded.ptr<std::uint16_t>(y);
    for (int x = 0; x < decoded.cols; ++x) *depth.At(x, y) = static_cast<float>(unit * row[x]);
  }
  return depth;
}

}  // namespace simwright::core
