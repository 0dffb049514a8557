#include "capture/color_mixture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <opencv2/core.hpp>

#include "core/error.h"

namespace simwright::capture {
namespace {

constexpr int kClusters = 5, kRounds = 10, kClusterSeed = 1;
constexpr std::size_t kMostSamples = 4000;
constexpr float kLeastVariance = 25.0f;  // levels^2, of each channel: the photo's own noise
constexpr float kUniformShare = 0.05f;
constexpr float kUniformDensity = 1.0f / (256.0f * 256.0f * 256.0f);

}  // namespace

ColorMixture::ColorMixture(const std::vector<Eigen::Vector3f>& sample) {
  if (sample.empty()) throw core::Error("a sample has no colours", "colour mixture");
  const std::size_t stride = (sample.size() + kMostSamples - 1) / kMostSamples;
  cv::Mat values;
  for (std::size_t i = 0; i < sample.size(); i += stride) {
    values.push_back(cv::Vec3f(sample[i].x(), sample[i].y(), sample[i].z()));
  }
  cv::Mat labels;
  cv::setRNGSeed(kClusterSeed);  // of this thread: the same sample gives the same mixture
  cv::kmeans(values.reshape(1), std::min(kClusters, values.rows), labels,
             {cv::TermCriteria::MAX_ITER, kRounds, 0.0}, 1, cv::KMEANS_PP_CENTERS);
  for (int k = 0; k < kClusters; ++k) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    int count = 0;
    for (int i = 0; i < values.rows; ++i) {
      if (labels.at<int>(i) != k) continue;
      const cv::Vec3f& v = values.at<cv::Vec3f>(i);
      const Eigen::Vector3d color(v[0], v[1], v[2]);
      sum += color;
      squares += color * color.transpose();
      ++count;
    }
    if (count == 0) continue;
    const auto n = static_cast<double>(count);
    const Eigen::Vector3d mean = sum / n;
    const Eigen::Matrix3d spread = squares / n - mean * mean.transpose();
    const Eigen::Matrix3f covariance =
        spread.cast<float>() + kLeastVariance * Eigen::Matrix3f::Identity();
    Gaussian gaussian;
    gaussian.mean = mean.cast<float>();
    gaussian.inverse = covariance.inverse();
    constexpr float kTurn = 2.0f * std::numbers::pi_v<float>;
    gaussian.factor = (1.0f - kUniformShare) * static_cast<float>(n / values.rows) /
                      std::sqrt(kTurn * kTurn * kTurn * covariance.determinant());
    gaussians_.push_back(gaussian);
  }
}

float ColorMixture::Cost(const Eigen::Vector3f& color) const {
  float density = kUniformShare * kUniformDensity;
  for (const Gaussian& gaussian : gaussians_) {
    const Eigen::Vector3f off = color - gaussian.mean;
    density += gaussian.factor * std::exp(-0.5f * off.dot(gaussian.inverse * off));
  }
  return -std::log(density);
}

}  // namespace simwright::capture
