#include "capture/outline_matte.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace simwright::capture {
namespace {

constexpr double kBandShare = 0.015;  // of the mask's size, on both sides of its outline
constexpr double kLeastBand = 3.0;    // pixels
constexpr float kMatteNoise = 6.0f;   // standard deviation, of 255
constexpr float kMatteEdgeShare =
    0.4f;  // of the mat's change within a pixel, which counts as noise
constexpr float kLightDeviation = 0.12f;  // of the light from that of the mat around
constexpr float kMaskWeight = 0.5f;       // of the squared difference from the mask
constexpr float kLeastMatteLight = 0.25f, kMostMatteLight = 1.1f;
constexpr float kMatteBlur = 0.7f;  // pixels, of the result

float Squared(const cv::Vec3f& v) {
  return v.dot(v);
}

class OutlineMatte {
 public:
  OutlineMatte(const core::Image& photo, const MatEvidence& evidence, const core::FloatImage& mask)
      : evidence_(evidence), mask_(mask), size_(photo.width, photo.height) {
    const cv::Mat source(size_, CV_8UC(photo.channels),
                         const_cast<std::uint8_t*>(photo.pixels.data()));
    cv::Mat rgb = source;
    if (photo.channels == 4) cv::cvtColor(source, rgb, cv::COLOR_RGBA2RGB);
    rgb.convertTo(color_, CV_32FC3);
    const cv::Mat expected(size_, CV_8UC3,
                           const_cast<std::uint8_t*>(evidence.expected.pixels.data()));
    expected.convertTo(expected_, CV_32FC3);
    cv::Mat inside(size_, CV_8U);
    for (int y = 0; y < size_.height; ++y) {
      for (int x = 0; x < size_.width; ++x) inside.at<std::uint8_t>(y, x) = *mask.At(x, y) >= 0.5f;
    }
    const cv::Rect box = cv::boundingRect(inside);
    band_ = static_cast<float>(kLeastBand + kBandShare * std::max(box.width, box.height));
    cv::distanceTransform(inside, depth_, cv::DIST_L2, 5);
    cv::distanceTransform(1 - inside, distance_, cv::DIST_L2, 5);
    MeasureLight();
  }

  core::FloatImage Run() const {
    core::FloatImage opacity = mask_;
    for (int y = 0; y < size_.height; ++y) {
      for (int x = 0; x < size_.width; ++x) {
        const float from = std::max(depth_.at<float>(y, x), distance_.at<float>(y, x));
        if (from > band_ || *evidence_.difference.At(x, y) < 0.0f) continue;
        *opacity.At(x, y) = OpacityAt(x, y);
      }
    }
    cv::Mat values(size_, CV_32F, opacity.values.data());
    cv::GaussianBlur(values, values, {0, 0}, kMatteBlur);
    return opacity;
  }

 private:
  // The share of the mat's light that is left around each pixel, from the mat outside of the band.
  void MeasureLight() {
    cv::Mat sum(size_, CV_32F, cv::Scalar(0)), total(size_, CV_32F, cv::Scalar(0));
    for (int y = 0; y < size_.height; ++y) {
      for (int x = 0; x < size_.width; ++x) {
        const float away = distance_.at<float>(y, x);
        if (away <= 0.5f * band_ || *evidence_.difference.At(x, y) < 0.0f) continue;
        const cv::Vec3f &seen = color_.at<cv::Vec3f>(y, x), &full = expected_.at<cv::Vec3f>(y, x);
        sum.at<float>(y, x) = seen.dot(full);
        total.at<float>(y, x) = full.dot(full);
      }
    }
    cv::GaussianBlur(sum, sum, {0, 0}, band_);
    cv::GaussianBlur(total, total, {0, 0}, band_);
    light_ = cv::Mat(size_, CV_32F, cv::Scalar(1));
    for (int y = 0; y < size_.height; ++y) {
      for (int x = 0; x < size_.width; ++x) {
        const float t = total.at<float>(y, x);
        if (t > 1.0f) {
          light_.at<float>(y, x) =
              std::clamp(sum.at<float>(y, x) / t, kLeastMatteLight, kMostMatteLight);
        }
      }
    }
  }

  // Returns colours of the object on the way from a pixel to the mask's inside.
  int Samples(int x, int y, std::array<cv::Vec3f, 8>* samples) const {
    int count = 0;
    const int steps = static_cast<int>(2.0f * band_) + 2;
    for (int step = 0; step < steps && count < 8; ++step) {
      // Outside of the mask the way leads to it, inside away from its outline.
      int bx = x, by = y;
      float best = depth_.at<float>(y, x) - distance_.at<float>(y, x);
      for (int j = std::max(0, y - 1); j <= std::min(size_.height - 1, y + 1); ++j) {
        for (int i = std::max(0, x - 1); i <= std::min(size_.width - 1, x + 1); ++i) {
          const float height = depth_.at<float>(j, i) - distance_.at<float>(j, i);
          if (height > best) best = height, bx = i, by = j;
        }
      }
      const bool top = bx == x && by == y;
      x = bx;
      y = by;
      if (best > 0.7f * band_ || top)
        (*samples)[static_cast<std::size_t>(count++)] = color_.at<cv::Vec3f>(y, x);
      if (top) break;
    }
    return count;
  }

  float OpacityAt(int x, int y) const {
    std::array<cv::Vec3f, 8> objects;
    const int count = Samples(x, y, &objects);
    const cv::Vec3f seen = color_.at<cv::Vec3f>(y, x), full = expected_.at<cv::Vec3f>(y, x);
    const float mask = *mask_.At(x, y) >= 0.5f ? 1.0f : 0.0f;
    const float local = light_.at<float>(y, x);
    const float noise = kMatteNoise + EdgeAt(x, y);
    float best = 1e9f, opacity = mask;
    for (float light = kLeastMatteLight; light <= kMostMatteLight; light += 0.05f) {
      const float off = (light - local) / kLightDeviation;
      const cv::Vec3f mat = light * full;
      for (int k = 0; k < count; ++k) {
        const cv::Vec3f& object = objects[static_cast<std::size_t>(k)];
        const cv::Vec3f across = object - mat;
        const float contrast = Squared(across) / (3.0f * noise * noise);
        // The least of contrast (share - at)^2 + kMaskWeight (share - mask)^2.
        const float at = Squared(across) > 0.0f ? (seen - mat).dot(across) / Squared(across) : mask;
        const float share =
            std::clamp((contrast * at + kMaskWeight * mask) / (contrast + kMaskWeight), 0.0f, 1.0f);
        const float cost = Squared(seen - mat - share * across) / (3.0f * noise * noise) +
                           off * off * (1.0f - share) +
                           kMaskWeight * (share - mask) * (share - mask);
        if (cost < best) best = cost, opacity = share;
      }
    }
    return opacity;
  }

  // The noise that the mat's own edges add.
  float EdgeAt(int x, int y) const {
    cv::Vec3f low = expected_.at<cv::Vec3f>(y, x), high = low;
    for (int j = std::max(0, y - 1); j <= std::min(size_.height - 1, y + 1); ++j) {
      for (int i = std::max(0, x - 1); i <= std::min(size_.width - 1, x + 1); ++i) {
        for (int c = 0; c < 3; ++c) {
          low[c] = std::min(low[c], expected_.at<cv::Vec3f>(j, i)[c]);
          high[c] = std::max(high[c], expected_.at<cv::Vec3f>(j, i)[c]);
        }
      }
    }
    return kMatteEdgeShare * std::sqrt(Squared(high - low) / 3.0f);
  }

  const MatEvidence& evidence_;
  const core::FloatImage& mask_;
  cv::Size size_;
  cv::Mat color_, expected_;  // CV_32FC3; the mat's without shadow
  cv::Mat depth_, distance_;  // to the outline, inside and outside of the mask, pixels
  cv::Mat light_;
  float band_ = 0.0f;
};

}  // namespace

core::FloatImage MatteOnMat(const core::Image& photo, const MatEvidence& evidence,
                            const core::FloatImage& mask) {
  const auto fits = [&](int width, int height) {
    return width == photo.width && height == photo.height;
  };
  if (!fits(mask.width, mask.height) || !fits(evidence.expected.width, evidence.expected.height) ||
      !fits(evidence.difference.width, evidence.difference.height)) {
    throw core::Error("photo, mat and mask differ in size", "matte on the mat");
  }
  return OutlineMatte(photo, evidence, mask).Run();
}

}  // namespace simwright::capture
