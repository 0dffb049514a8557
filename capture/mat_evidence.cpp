#include "capture/mat_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/parallel.h"

namespace simwright::capture {
namespace {

constexpr double kPicturePixels = 4000.0;  // of the mat's picture, per metre
constexpr int kSubPixels = 3;              // per side, of the mat's albedo in a pixel
constexpr float kRecognised = 0.85f;       // correlation from which a window shows the mat
constexpr float kLeastVariance = 0.01f;    // of the albedo in a window with a pattern
constexpr float kNoise = 6.0f;             // standard deviation of a pixel's value, of 255
constexpr float kEdgeShare = 0.4f;    // of the change across an edge, which a camera's error shows
constexpr float kUsualShadow = 0.6f;  // share of the light that a soft shadow leaves ...
constexpr float kDarkestShadow = 0.3f;     // ... and one under an overhang
constexpr float kShadowDeviation = 0.08f;  // of shadows darker than usual

// Returns the mat's albedo at a point of its plane, or -1 beside the printed area.
float AlbedoAt(const core::Image& picture, const CaptureMat& mat,
               const Eigen::AlignedBox2d& printed, double x, double y) {
  if (!printed.contains(Eigen::Vector2d(x, y))) return -1.0f;
  const double u = (x + 0.5 * mat.width) / mat.width * picture.width;
  const double v = (0.5 * mat.height - y) / mat.height * picture.height;
  return static_cast<float>(*picture.At(std::clamp(static_cast<int>(u), 0, picture.width - 1),
                                        std::clamp(static_cast<int>(v), 0, picture.height - 1))) /
         255.0f;
}

core::FloatImage AlbedoOf(const core::Camera& camera, const CaptureMat& mat, double print_scale) {
  const core::Image picture = MatPicture(mat, kPicturePixels);
  core::FloatImage albedo(camera.width, camera.height, 1, -1.0f);
  const Eigen::AlignedBox2d printed = mat.Printed();
  const Eigen::Vector3d eye = camera.position();
  core::ParallelFor(camera.height, [&](int y) {
    for (int x = 0; x < camera.width; ++x) {
      float sum = 0.0f;
      bool inside = true;
      for (int k = 0; k < kSubPixels * kSubPixels && inside; ++k) {
        const Eigen::Vector3d ray = camera.Ray(
            {x + (k % kSubPixels + 0.5) / kSubPixels, y + (k / kSubPixels + 0.5) / kSubPixels});
        const double t = -eye.z() / ray.z();
        const float value =
            t > 0.0 ? AlbedoAt(picture, mat, printed, (eye.x() + t * ray.x()) / print_scale,
                               (eye.y() + t * ray.y()) / print_scale)
                    : -1.0f;
        inside = value >= 0.0f;
        sum += value;
      }
      if (inside) *albedo.At(x, y) = sum / (kSubPixels * kSubPixels);
    }
  });
  return albedo;
}

// Returns 1 where a photo without an object shows the page beside the printed area.
core::FloatImage MarginOf(const core::Camera& camera, const CaptureMat& mat, double print_scale) {
  core::FloatImage margin(camera.width, camera.height, 1);
  const Eigen::AlignedBox2d printed = mat.Printed();
  const Eigen::Vector2d half(0.5 * mat.width, 0.5 * mat.height);
  const Eigen::AlignedBox2d page(-half, half);
  const Eigen::Vector3d eye = camera.position();
  core::ParallelFor(camera.height, [&](int y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d ray = camera.Ray({x + 0.5, y + 0.5});
      const double t = -eye.z() / ray.z();
      if (!(t > 0.0)) continue;
      const Eigen::Vector2d at = (eye + t * ray).head<2>() / print_scale;
      *margin.At(x, y) = page.contains(at) && !printed.contains(at);
    }
  });
  return margin;
}

// Returns the side of a square of the mat in the photo at the page's centre, pixels.
double SquarePixels(const core::Camera& camera, const CaptureMat& mat, double print_scale) {
  const double depth = camera.Project(Eigen::Vector3d::Zero()).z();
  return std::max(4.0, print_scale * mat.square * camera.fx / std::max(depth, 1e-6));
}

cv::Mat BoxSum(const cv::Mat& values, int window) {
  cv::Mat sum;
  cv::boxFilter(values, sum, CV_32F, {window, window}, {-1, -1}, false, cv::BORDER_CONSTANT);
  return sum;
}

// Returns the correlation of grey values and albedo in a window about each pixel.
cv::Mat PatternCorrelation(const cv::Mat& grey, const cv::Mat& albedo, const cv::Mat& valid,
                           int window) {
  const cv::Mat a = albedo.mul(valid), g = grey.mul(valid);
  const cv::Mat n = BoxSum(valid, window), sa = BoxSum(a, window), sg = BoxSum(g, window),
                saa = BoxSum(a.mul(a), window), sgg = BoxSum(g.mul(g), window),
                sag = BoxSum(a.mul(g), window);
  cv::Mat correlation(grey.size(), CV_32F, cv::Scalar(0));
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x) {
      const float count = n.at<float>(y, x);
      if (valid.at<float>(y, x) == 0.0f || count < 9.0f) continue;
      const float ma = sa.at<float>(y, x) / count, mg = sg.at<float>(y, x) / count;
      const float va = saa.at<float>(y, x) / count - ma * ma;
      const float vg = sgg.at<float>(y, x) / count - mg * mg;
      if (va < kLeastVariance) continue;
      // An even surface where the mat has a pattern correlates with nothing.
      const float covariance = sag.at<float>(y, x) / count - ma * mg;
      correlation.at<float>(y, x) =
          std::clamp(covariance / std::sqrt(va * std::max(vg, kNoise * kNoise)), -1.0f, 1.0f);
    }
  }
  return correlation;
}

// Spreads the colours of the pixels with weight over the image: an average weighted by distance.
cv::Mat Spread(const cv::Mat& colors, const cv::Mat& weight, double sigma) {
  cv::Mat sum(colors.size(), CV_32FC3, cv::Scalar::all(0)),
      total(colors.size(), CV_32F, cv::Scalar(1e-6));
  cv::Mat weighted;
  cv::Mat weights3;
  cv::merge(std::array<cv::Mat, 3>{weight, weight, weight}.data(), 3, weights3);
  cv::multiply(colors, weights3, weighted);
  // A wide kernel of little weight fills what the narrow ones do not reach.
  double share = 1.0;
  for (const double scale : {1.0, 3.0, 9.0}) {
    const int shrink = std::max(1, static_cast<int>(scale * sigma / 2.0));
    const cv::Size small(std::max(1, colors.cols / shrink), std::max(1, colors.rows / shrink));
    cv::Mat c, w;
    cv::resize(weighted, c, small, 0, 0, cv::INTER_AREA);
    cv::resize(weight, w, small, 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(c, c, {0, 0}, scale * sigma / shrink);
    cv::GaussianBlur(w, w, {0, 0}, scale * sigma / shrink);
    cv::resize(c, c, colors.size(), 0, 0, cv::INTER_LINEAR);
    cv::resize(w, w, colors.size(), 0, 0, cv::INTER_LINEAR);
    sum += share * c;
    total += share * w;
    share *= 1e-3;
  }
  for (int y = 0; y < colors.rows; ++y) {
    for (int x = 0; x < colors.cols; ++x) sum.at<cv::Vec3f>(y, x) /= total.at<float>(y, x);
  }
  return sum;
}

// Returns the distance of a colour from the mat's, in deviations, under the best soft shadow.
float DifferenceAt(const cv::Vec3f& color, const cv::Vec3f& dark, const cv::Vec3f& light_color,
                   float albedo, float edge) {
  float best = 1e9f;
  for (float light = kDarkestShadow; light <= 1.05f; light += 0.05f) {
    const float darker = std::max(0.0f, kUsualShadow - light) / kShadowDeviation;
    float squared = darker * darker;
    for (int c = 0; c < 3; ++c) {
      const float range = light_color[c] - dark[c];
      const float expected = light * (dark[c] + albedo * range);
      const float deviation = kNoise + edge * std::abs(range);
      const float d = (color[c] - expected) / deviation;
      squared += d * d;
    }
    best = std::min(best, squared);
  }
  return std::sqrt(best / 3.0f);
}

}  // namespace

MatEvidence CompareWithMat(const core::Image& photo, const core::Camera& camera,
                           const CaptureMat& mat, double print_scale) {
  if (photo.width != camera.width || photo.height != camera.height || photo.channels < 3) {
    throw core::Error("the photo does not have the size of its camera", "mat comparison");
  }
  MatEvidence evidence;
  evidence.albedo = AlbedoOf(camera, mat, print_scale);
  evidence.margin = MarginOf(camera, mat, print_scale);
  const cv::Size size(photo.width, photo.height);
  const cv::Mat albedo(size, CV_32F, evidence.albedo.values.data());
  cv::Mat rgb(size, CV_8UC(photo.channels), const_cast<std::uint8_t*>(photo.pixels.data()));
  cv::Mat color, grey, valid;
  if (photo.channels == 4) cv::cvtColor(rgb, rgb, cv::COLOR_RGBA2RGB);
  rgb.convertTo(color, CV_32FC3);
  cv::cvtColor(color, grey, cv::COLOR_RGB2GRAY);
  cv::threshold(albedo, valid, -0.5, 1.0, cv::THRESH_BINARY);
  const double square = SquarePixels(camera, mat, print_scale);
  const int window = 2 * static_cast<int>(0.35 * square) + 1;
  const cv::Mat pattern = PatternCorrelation(grey, albedo, valid, window);

  cv::Mat is_dark(size, CV_32F, cv::Scalar(0)), is_light(size, CV_32F, cv::Scalar(0));
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (pattern.at<float>(y, x) < kRecognised) continue;
      is_dark.at<float>(y, x) = albedo.at<float>(y, x) < 0.02f;
      is_light.at<float>(y, x) = albedo.at<float>(y, x) > 0.98f;
    }
  }
  const cv::Mat dark = Spread(color, is_dark, square),
                light_color = Spread(color, is_light, square);
  // The albedo's change between neighbouring pixels: a camera half a pixel off shows that much.
  cv::Mat highest, lowest;
  cv::dilate(albedo, highest, {});
  cv::erode(albedo, lowest, {});
  evidence.difference = core::FloatImage(photo.width, photo.height, 1, -1.0f);
  evidence.pattern = core::FloatImage(photo.width, photo.height, 1);
  evidence.expected = core::Image(photo.width, photo.height, 3);
  core::ParallelFor(size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      *evidence.pattern.At(x, y) = pattern.at<float>(y, x);
      const float a = albedo.at<float>(y, x);
      if (a < 0.0f) continue;
      const cv::Vec3f &ink = dark.at<cv::Vec3f>(y, x), &paper = light_color.at<cv::Vec3f>(y, x);
      for (int c = 0; c < 3; ++c) {
        evidence.expected.At(x, y)[c] =
            cv::saturate_cast<std::uint8_t>(ink[c] + a * (paper[c] - ink[c]));
      }
      const float edge =
          kEdgeShare * (highest.at<float>(y, x) - std::max(0.0f, lowest.at<float>(y, x)));
      *evidence.difference.At(x, y) = DifferenceAt(color.at<cv::Vec3f>(y, x), ink, paper, a, edge);
    }
  });
  return evidence;
}

}  // namespace simwright::capture
