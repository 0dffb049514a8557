#include "asset_lift/segmentation/outline_contrast.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace simwright::asset_lift {
namespace {

constexpr double kAlikeContrast = 6.0;  // CIELAB: colours that look alike side by side
constexpr double kAside = 0.012;        // of the longer side, from the outline
constexpr int kTangent = 5;             // outline points on each side that give its direction
constexpr int kFewest = 20;

cv::Mat SmoothLab(const core::Image& photo) {
  cv::Mat rgb(photo.height, photo.width, CV_32FC3);
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        rgb.at<cv::Vec3f>(y, x)[c] = photo.At(x, y)[photo.channels < 3 ? 0 : c] / 255.0f;
      }
    }
  }
  cv::Mat lab;
  cv::cvtColor(rgb, lab, cv::COLOR_RGB2Lab);
  cv::GaussianBlur(lab, lab, cv::Size(0, 0), 1.0);
  return lab;
}

std::vector<cv::Point> LongestOutline(const cv::Mat& mask) {
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(mask, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  const auto longest =
      std::max_element(outlines.begin(), outlines.end(),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  return longest == outlines.end() ? std::vector<cv::Point>() : *longest;
}

}  // namespace

double WeakOutlineShare(const core::Image& photo, const cv::Mat& mask) {
  const cv::Mat lab = SmoothLab(photo);
  const std::vector<cv::Point> outline = LongestOutline(mask);
  const int count = static_cast<int>(outline.size());
  const double aside = std::max(2.0, kAside * std::max(photo.width, photo.height));
  const cv::Rect frame(0, 0, photo.width, photo.height);
  int seen = 0, weak = 0;
  for (int i = 0; i < count; ++i) {
    const cv::Point2d along = outline[static_cast<size_t>((i + kTangent) % count)] -
                              outline[static_cast<size_t>((i + count - kTangent) % count)];
    const double length = std::hypot(along.x, along.y);
    if (length < 1.0) continue;
    const cv::Point2d normal = cv::Point2d(-along.y, along.x) * (aside / length);
    const cv::Point2d at = outline[static_cast<size_t>(i)];
    const cv::Point one = at + normal, other = at - normal;
    if (!frame.contains(one) || !frame.contains(other)) continue;
    ++seen;
    weak += cv::norm(lab.at<cv::Vec3f>(one) - lab.at<cv::Vec3f>(other)) < kAlikeContrast;
  }
  return seen < kFewest ? 0.0 : static_cast<double>(weak) / seen;
}

}  // namespace simwright::asset_lift
