#include "asset_lift/camera/depth_map.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace simwright::asset_lift {
namespace {

// Solves Laplace(u) = -c on the mask by successive over-relaxation, coarse to fine, with a few
// iterations per level.
cv::Mat SolvePoisson(const cv::Mat& mask, double c) {
  cv::Mat u;
  if (std::min(mask.rows, mask.cols) > 24) {
    cv::Mat coarse_mask;
    cv::resize(mask, coarse_mask, cv::Size((mask.cols + 1) / 2, (mask.rows + 1) / 2), 0, 0,
               cv::INTER_AREA);
    const cv::Mat coarse = SolvePoisson(coarse_mask > 127, c);
    cv::resize(coarse, u, mask.size(), 0, 0, cv::INTER_LINEAR);
    u *= 4.0;  // pixels are half as wide at this level
  } else {
    u = cv::Mat::zeros(mask.size(), CV_32F);
  }
  u.setTo(0.0f, mask == 0);
  constexpr int kIterations = 60;
  constexpr float kOmega = 1.6f;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (int y = 0; y < u.rows; ++y) {
      for (int x = 0; x < u.cols; ++x) {
        if (mask.at<uchar>(y, x) == 0) continue;
        const auto at = [&](int px, int py) {
          return px < 0 || py < 0 || px >= u.cols || py >= u.rows ? 0.0f : u.at<float>(py, px);
        };
        const float mean = 0.25f * (at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1) +
                                    static_cast<float>(c));
        float& value = u.at<float>(y, x);
        value += kOmega * (mean - value);
      }
    }
  }
  return u;
}

// Returns the minor over the major half axis of the mask's second moments, in (0, 1].
double Roundness(const cv::Mat& mask) {
  const cv::Moments m = cv::moments(mask, true);
  if (m.m00 <= 0.0) return 1.0;
  const double a = m.mu20 / m.m00, b = m.mu11 / m.m00, c = m.mu02 / m.m00;
  const double mean = 0.5 * (a + c), spread = std::sqrt(0.25 * (a - c) * (a - c) + b * b);
  return std::sqrt(std::max(1e-6, (mean - spread) / (mean + spread)));
}

// Extends the field outside the mask: it falls with the distance at the rate of a ball's edge, so
// that its zero level is interpolated without staircase artefacts.
void ContinueOutside(const cv::Mat& mask, cv::Mat* u) {
  const cv::Mat distance = SignedEdgeDistance(mask);
  double deepest = 0.0;
  cv::minMaxLoc(*u, nullptr, &deepest);
  const float slope = 2.0f * static_cast<float>(std::sqrt(std::max(1.0, deepest)));
  for (int y = 0; y < u->rows; ++y) {
    for (int x = 0; x < u->cols; ++x) {
      const float d = distance.at<float>(y, x);
      if (d <= 0.0f) u->at<float>(y, x) = slope * d;
      // The first pixels inside are at least as deep as those of a round edge.
      if (d > 0.0f) u->at<float>(y, x) = std::max(u->at<float>(y, x), 0.5f * slope * d * 0.25f);
    }
  }
}

}  // namespace

cv::Mat SignedEdgeDistance(const cv::Mat& mask) {
  cv::Mat inside, outside;
  cv::distanceTransform(mask, inside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(mask == 0, outside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  // Distances are measured from pixel centres; the edge runs half way between them.
  cv::Mat distance = inside - outside;
  for (int y = 0; y < distance.rows; ++y) {
    for (int x = 0; x < distance.cols; ++x) {
      distance.at<float>(y, x) += mask.at<uchar>(y, x) ? -0.5f : 0.5f;
    }
  }
  return distance;
}

cv::Mat PoissonDepth(const cv::Mat& mask) {
  const double roundness = Roundness(mask);
  // The solution for an ellipse is c / (2 (1/A^2 + 1/B^2)) at the centre; this c makes it B^2.
  const double c = 2.0 * (1.0 + roundness * roundness);
  cv::Mat u = SolvePoisson(mask, c);
  ContinueOutside(mask, &u);
  return u;
}

cv::Mat RevolvedDepth(const cv::Mat& mask, const cv::Point2d& center, const cv::Point2d& axis) {
  // The half width of each slice across the axis is half its area, which needs no edge.
  const int reach = static_cast<int>(std::hypot(mask.cols, mask.rows)) + 2;
  std::vector<double> width(static_cast<size_t>(2 * reach + 1), 0.0);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (mask.at<uchar>(y, x) == 0) continue;
      const double s = (x - center.x) * axis.x + (y - center.y) * axis.y + reach;
      const int low = static_cast<int>(std::floor(s));
      width[static_cast<size_t>(low)] += 1.0 - (s - low);
      width[static_cast<size_t>(low + 1)] += s - low;
    }
  }
  cv::Mat u(mask.size(), CV_32F);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      const double dx = x - center.x, dy = y - center.y;
      const double s = dx * axis.x + dy * axis.y + reach, t = dx * axis.y - dy * axis.x;
      const int low = static_cast<int>(std::floor(s));
      const double r = 0.5 * (width[static_cast<size_t>(low)] * (1.0 - (s - low)) +
                              width[static_cast<size_t>(low + 1)] * (s - low));
      u.at<float>(y, x) = static_cast<float>(r * r - t * t);
    }
  }
  // The silhouette itself bounds the body's ends.
  const cv::Mat edge = SignedEdgeDistance(mask);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      const float d = edge.at<float>(y, x);
      float& value = u.at<float>(y, x);
      value = d > 0.0f ? std::max(value, 2.0f * d) : std::min(value, 8.0f * d);
    }
  }
  return u;
}

MirrorAxis FindMirrorAxis(const cv::Mat& mask) {
  const cv::Moments m = cv::moments(mask, true);
  MirrorAxis best;
  best.center = {m.m10 / m.m00, m.m01 / m.m00};
  for (int degrees = 0; degrees < 180; degrees += 2) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const cv::Point2d d(std::cos(angle), std::sin(angle));
    // Reflection about the line: x -> c + (2 d d^T - I)(x - c).
    const double a = 2 * d.x * d.x - 1, b = 2 * d.x * d.y;
    const cv::Matx23d reflect(a, b, best.center.x - a * best.center.x - b * best.center.y, b, -a,
                              best.center.y - b * best.center.x + a * best.center.y);
    cv::Mat mirrored;
    cv::warpAffine(mask, mirrored, reflect, mask.size(), cv::INTER_NEAREST);
    const double both = cv::countNonZero(mask & mirrored);
    const double agreement = both / (2.0 * m.m00 - both);
    if (agreement > best.agreement) {
      best.agreement = agreement;
      best.direction = d;
    }
  }
  return best;
}

}  // namespace simwright::asset_lift
