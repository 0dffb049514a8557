#include "texture/painting/perceptual_distance.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace simwright::texture {
namespace {

// RGB in [0, 1] on white.
cv::Mat OnWhite(const core::Image& image) {
  cv::Mat picture(image.height, image.width, CV_32FC3);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* at = image.At(x, y);
      const float alpha = image.channels == 4 ? static_cast<float>(at[3]) / 255.0f : 1.0f;
      for (int c = 0; c < 3; ++c) {
        const float value = static_cast<float>(at[image.channels < 3 ? 0 : c]) / 255.0f;
        picture.at<cv::Vec3f>(y, x)[c] = alpha * value + 1.0f - alpha;
      }
    }
  }
  return picture;
}

cv::Mat Blurred(const cv::Mat& picture) {
  cv::Mat blurred;
  cv::GaussianBlur(picture, blurred, {11, 11}, 1.5, 1.5, cv::BORDER_REFLECT);
  return blurred;
}

// The means over the picture of SSIM's luminance-and-structure term and of the structure alone.
struct SsimMeans {
  double full = 1.0, structure = 1.0;
};

SsimMeans SsimOf(const cv::Mat& a, const cv::Mat& b) {
  constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
  const cv::Mat ma = Blurred(a), mb = Blurred(b);
  const cv::Mat va = Blurred(a.mul(a)) - ma.mul(ma), vb = Blurred(b.mul(b)) - mb.mul(mb);
  const cv::Mat vab = Blurred(a.mul(b)) - ma.mul(mb);
  cv::Mat structure, light;
  cv::divide(2.0 * vab + kC2, va + vb + kC2, structure);
  cv::divide(2.0 * ma.mul(mb) + kC1, ma.mul(ma) + mb.mul(mb) + kC1, light);
  return {cv::mean(structure.mul(light))[0], cv::mean(structure)[0]};
}

double MsSsim(cv::Mat a, cv::Mat b) {
  constexpr double kWeights[] = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};
  double product = 1.0, weights = 0.0;
  for (int scale = 0; scale < 5; ++scale) {
    const bool is_last = scale == 4 || std::min(a.cols, a.rows) < 22;
    const SsimMeans means = SsimOf(a, b);
    const double value = std::max(0.0, is_last ? means.full : means.structure);
    product *= std::pow(value, kWeights[scale]);
    weights += kWeights[scale];
    if (is_last) break;
    cv::resize(a, a, {a.cols / 2, a.rows / 2}, 0, 0, cv::INTER_AREA);
    cv::resize(b, b, {b.cols / 2, b.rows / 2}, 0, 0, cv::INTER_AREA);
  }
  return std::pow(product, 1.0 / weights);
}

}  // namespace

PerceptualDistance ComparePictures(const core::Image& a, const core::Image& b) {
  if (a.width != b.width || a.height != b.height || std::min(a.width, a.height) < 16) {
    throw core::Error("pictures are compared at one size of at least 16 pixels per side");
  }
  const cv::Mat first = OnWhite(a), second = OnWhite(b);
  cv::Mat grey_a, grey_b, lab_a, lab_b;
  cv::cvtColor(first, grey_a, cv::COLOR_RGB2GRAY);
  cv::cvtColor(second, grey_b, cv::COLOR_RGB2GRAY);
  cv::cvtColor(first, lab_a, cv::COLOR_RGB2Lab);
  cv::cvtColor(second, lab_b, cv::COLOR_RGB2Lab);
  PerceptualDistance distance;
  distance.structure = 1.0 - MsSsim(grey_a, grey_b);
  double sum = 0.0, count = 0.0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const auto shows = [&](const core::Image& image) {
        return image.channels != 4 || image.At(x, y)[3] > 127;
      };
      if (!shows(a) && !shows(b)) continue;
      sum += cv::norm(lab_a.at<cv::Vec3f>(y, x) - lab_b.at<cv::Vec3f>(y, x));
      ++count;
    }
  }
  distance.color = count > 0.0 ? sum / count : 0.0;
  return distance;
}

}  // namespace simwright::texture
