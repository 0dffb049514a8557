#include "asset_lift/segmentation/round_outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "core/random.h"

namespace simwright::asset_lift {
namespace {

struct Gradient {
  cv::Mat x, y;  // CV_32F, of the CIELAB channel that changes most
  float strong = 1.0f;
};

Gradient ImageGradient(const cv::Mat& bgr) {
  cv::Mat lab;
  cv::GaussianBlur(bgr, lab, cv::Size(), 1.5);
  cv::cvtColor(lab, lab, cv::COLOR_BGR2Lab);
  std::vector<cv::Mat> channels;
  cv::split(lab, channels);
  Gradient gradient{cv::Mat::zeros(bgr.size(), CV_32F), cv::Mat::zeros(bgr.size(), CV_32F), 1.0f};
  std::vector<float> magnitudes;
  for (const cv::Mat& channel : channels) {
    cv::Mat gx, gy;
    cv::Sobel(channel, gx, CV_32F, 1, 0);
    cv::Sobel(channel, gy, CV_32F, 0, 1);
    const cv::Mat stronger =
        (gx.mul(gx) + gy.mul(gy)) > (gradient.x.mul(gradient.x) + gradient.y.mul(gradient.y));
    gx.copyTo(gradient.x, stronger);
    gy.copyTo(gradient.y, stronger);
  }
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; ++x) {
      magnitudes.push_back(std::hypot(gradient.x.at<float>(y, x), gradient.y.at<float>(y, x)));
    }
  }
  // Edges are the strongest sixth of the image's gradients.
  const size_t rank = magnitudes.size() * 5 / 6;
  std::nth_element(magnitudes.begin(), magnitudes.begin() + static_cast<long>(rank),
                   magnitudes.end());
  gradient.strong = std::max(6.0f, magnitudes[rank]);
  return gradient;
}

// Returns the share of the ellipse's rim, inside the image, that has a parallel edge within two
// pixels.
double RimSupport(const cv::RotatedRect& e, const Gradient& gradient) {
  constexpr int kSteps = 120;
  const double turn = e.angle * std::numbers::pi / 180.0;
  const double c = std::cos(turn), s = std::sin(turn);
  const double a = 0.5 * e.size.width, b = 0.5 * e.size.height;
  int supported = 0, outside = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 2.0 * std::numbers::pi * i / kSteps;
    const double lx = a * std::cos(t), ly = b * std::sin(t);
    double nx = std::cos(t) / a, ny = std::sin(t) / b;
    const double norm = std::hypot(nx, ny);
    nx /= norm;
    ny /= norm;
    const double px = e.center.x + c * lx - s * ly, py = e.center.y + s * lx + c * ly;
    const double wx = c * nx - s * ny, wy = s * nx + c * ny;
    bool found = false, inside = true;
    for (int offset = -2; offset <= 2 && !found; ++offset) {
      const int x = static_cast<int>(std::lround(px + offset * wx));
      const int y = static_cast<int>(std::lround(py + offset * wy));
      inside = x >= 0 && y >= 0 && x < gradient.x.cols && y < gradient.x.rows;
      if (!inside) break;
      const double along = gradient.x.at<float>(y, x) * wx + gradient.y.at<float>(y, x) * wy;
      found = std::abs(along) > gradient.strong;
    }
    outside += !inside;
    supported += found;
  }
  return (supported - 0.5 * outside) / kSteps;
}

double Covered(const cv::RotatedRect& e, const cv::Mat& mask) {
  cv::Mat ellipse_mask = cv::Mat::zeros(mask.size(), CV_8U);
  cv::ellipse(ellipse_mask, e, cv::Scalar(255), -1);
  return cv::countNonZero(ellipse_mask & mask) /
         std::max(1.0, static_cast<double>(cv::countNonZero(mask)));
}

}  // namespace

std::optional<cv::RotatedRect> FitEllipseOutline(const cv::Mat& bgr, const cv::Mat& mask,
                                                 std::uint64_t seed, double support) {
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  if (contours.empty()) return std::nullopt;
  const std::vector<cv::Point>& contour =
      *std::max_element(contours.begin(), contours.end(),
                        [](const auto& a, const auto& b) { return a.size() < b.size(); });
  const auto count = static_cast<std::int64_t>(contour.size());
  if (count < 40) return std::nullopt;
  const Gradient gradient = ImageGradient(bgr);
  core::Rng rng(seed);
  std::optional<cv::RotatedRect> best;
  double best_score = 0.0;
  constexpr int kTrials = 3000;
  for (int trial = 0; trial < kTrials; ++trial) {
    // The points of two arcs sample a stretch of the true rim, whatever the rest of the outline
    // does.
    std::vector<cv::Point> points;
    for (int arc = 0; arc < 2; ++arc) {
      const std::int64_t start = core::UniformIndex(rng, count);
      const std::int64_t length = count / 12 + core::UniformIndex(rng, count / 4);
      for (int k = 0; k < 8; ++k) {
        points.push_back(contour[static_cast<size_t>((start + length * k / 8) % count)]);
      }
    }
    const cv::RotatedRect e = cv::fitEllipseDirect(points);
    const float low = std::min(e.size.width, e.size.height);
    const float high = std::max(e.size.width, e.size.height);
    if (!(low > 0.2f * static_cast<float>(std::min(mask.rows, mask.cols))) ||
        high > 1.05f * static_cast<float>(std::max(mask.rows, mask.cols)) || high > 1.34f * low) {
      continue;
    }
    const double rim = RimSupport(e, gradient);
    if (rim <= best_score) continue;
    if (Covered(e, mask) < 0.9) continue;
    best_score = rim;
    best = e;
  }
  return best_score >= support ? best : std::nullopt;
}

}  // namespace simwright::asset_lift
