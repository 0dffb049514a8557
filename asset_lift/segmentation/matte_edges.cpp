#include "asset_lift/segmentation/matte_edges.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/ximgproc/edge_filter.hpp>

namespace simwright::asset_lift {
namespace {

// In 8-bit units. With values in [0, 1], OpenCV 4.6 treats the covariance of a guide as singular
// and returns the box mean: a halo, in which thin parts vanish.
constexpr double kGuideEpsilon = 1e-3 * 255.0 * 255.0;

// The guided filter leaves a faint veil on both sides of an edge: opacities are stretched about one
// half by this factor.
constexpr double kEdgeGain = 2.0;

cv::Mat Disc(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(2 * radius + 1, 2 * radius + 1));
}

// Returns the mask at another size without the steps of its pixels.
cv::Mat SmoothlyScaled(const cv::Mat& mask, const cv::Size& size) {
  cv::Mat soft, scaled;
  mask.convertTo(soft, CV_32F);
  cv::GaussianBlur(soft, soft, cv::Size(), 1.0);
  cv::resize(soft, scaled, size, 0, 0, cv::INTER_CUBIC);
  return scaled > 127.0;
}

}  // namespace

cv::Mat PhotoInBgr(const core::Image& photo) {
  cv::Mat bgr(photo.height, photo.width, CV_8UC3);
  const bool grey = photo.channels < 3;
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) {
      const std::uint8_t* p = photo.At(x, y);
      bgr.at<cv::Vec3b>(y, x) = {p[grey ? 0 : 2], p[grey ? 0 : 1], p[0]};
    }
  }
  return bgr;
}

cv::Mat RefineMatte(const cv::Mat& photo_bgr, const cv::Mat& mask, int reach) {
  const double scale = static_cast<double>(photo_bgr.cols) / mask.cols;
  const int radius = std::max(1, static_cast<int>(std::lround(reach * scale)));
  const cv::Mat large = SmoothlyScaled(mask, photo_bgr.size());
  cv::Mat guided, inside, outside;
  cv::ximgproc::guidedFilter(photo_bgr, large, guided, 2 * radius, kGuideEpsilon, CV_32F);
  guided = (guided - 127.5) * kEdgeGain + 127.5;
  // The filter moves edges; it must not open the inside or reach far outside.
  cv::erode(large, inside, Disc(radius));
  cv::dilate(large, outside, Disc(radius));
  guided.setTo(255.0, inside);
  guided.setTo(0.0, outside == 0);
  cv::Mat alpha;
  guided.convertTo(alpha, CV_8U);
  return alpha;
}

}  // namespace simwright::asset_lift
