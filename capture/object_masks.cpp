#include "capture/object_masks.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "capture/outline_matte.h"
#include "core/error.h"
#include "render/forward.h"

namespace simwright::capture {
namespace {

constexpr int kIterations = 4;
constexpr int kSeed = 1;
constexpr float kSureMat = 1.5f;         // deviations under which a recognised pixel is the mat
constexpr float kLikelyMat = 2.5f;       // under which a pixel may be
constexpr float kSureObject = 6.0f;      // from which a pixel is no mat, where ...
constexpr float kNoPattern = 0.4f;       // ... the pattern is missing
constexpr float kCertainObject = 10.0f;  // from which it is no mat, whatever the pattern around
constexpr float kRecognisedMat = 0.8f;   // correlation of a window that shows the mat
constexpr double kHullMargin = 0.03;     // of the hull's size, by which the object may exceed it

std::uint8_t LabelOnMat(float difference, float pattern, bool printed) {
  if (difference < kSureMat && pattern > kRecognisedMat) return cv::GC_BGD;
  // Black resembles the mat in a deep shadow, but a shadow leaves the mat its pattern. (0: the mat
  // is even there.)
  const bool without_pattern = printed && pattern != 0.0f && pattern < kNoPattern;
  if (difference > kSureObject && pattern < kNoPattern) return cv::GC_FGD;
  // Thin parts leave the mat's pattern around them.
  if (printed && difference > kCertainObject) return cv::GC_FGD;
  if (difference < kSureObject && pattern > kRecognisedMat) return cv::GC_PR_BGD;
  return difference < (without_pattern ? kSureMat : kLikelyMat) ? cv::GC_PR_BGD : cv::GC_PR_FGD;
}

// Returns the hull's silhouette, grown by its margin; empty: there is no hull.
cv::Mat GrownHull(const core::FloatImage& hull) {
  if (hull.empty()) return {};
  cv::Mat inside(hull.height, hull.width, CV_8U);
  for (int y = 0; y < hull.height; ++y) {
    for (int x = 0; x < hull.width; ++x) inside.at<std::uint8_t>(y, x) = *hull.At(x, y) >= 0.5f;
  }
  const cv::Rect box = cv::boundingRect(inside);
  const int margin = 2 + static_cast<int>(kHullMargin * std::max(box.width, box.height));
  cv::Mat grown;
  cv::dilate(inside, grown,
             cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * margin + 1, 2 * margin + 1}));
  return grown;
}

core::FloatImage Softened(const cv::Mat& inside) {
  cv::Mat soft;
  inside.convertTo(soft, CV_32F);
  cv::GaussianBlur(soft, soft, {0, 0}, 0.8);
  core::FloatImage opacity(inside.cols, inside.rows, 1);
  for (int y = 0; y < inside.rows; ++y) {
    std::copy_n(soft.ptr<float>(y), inside.cols, opacity.At(0, y));
  }
  return opacity;
}

// Removes regions that are small against the largest one, and those that lie wholly beside the mat,
// which are background, where another one lies before it.
void KeepObjectRegions(const MatEvidence& evidence, cv::Mat* inside) {
  cv::Mat regions, stats, centers;
  const int count = cv::connectedComponentsWithStats(*inside, regions, stats, centers, 8);
  std::vector<char> before_mat(static_cast<std::size_t>(count), 0);
  for (int y = 0; y < inside->rows; ++y) {
    for (int x = 0; x < inside->cols; ++x) {
      if (*evidence.difference.At(x, y) < 0.0f) continue;
      before_mat[static_cast<std::size_t>(regions.at<int>(y, x))] = 1;
    }
  }
  const bool any_before =
      std::find(before_mat.begin() + 1, before_mat.end(), 1) != before_mat.end();
  const auto may_stay = [&](int region) {
    return !any_before || before_mat[static_cast<std::size_t>(region)] != 0;
  };
  int largest = 0;
  for (int i = 1; i < count; ++i) {
    if (may_stay(i)) largest = std::max(largest, stats.at<int>(i, cv::CC_STAT_AREA));
  }
  for (int y = 0; y < inside->rows; ++y) {
    for (int x = 0; x < inside->cols; ++x) {
      const int region = regions.at<int>(y, x);
      if (region > 0 &&
          (!may_stay(region) || stats.at<int>(region, cv::CC_STAT_AREA) < 0.03 * largest)) {
        inside->at<std::uint8_t>(y, x) = 0;
      }
    }
  }
}

}  // namespace

core::FloatImage SegmentOnMat(const core::Image& photo, const MatEvidence& evidence,
                              const core::FloatImage& hull) {
  if (evidence.difference.width != photo.width || evidence.difference.height != photo.height ||
      (!hull.empty() && (hull.width != photo.width || hull.height != photo.height))) {
    throw core::Error("photo, mat and hull differ in size", "segmentation on the mat");
  }
  const cv::Mat grown = GrownHull(hull);
  cv::Mat labels(photo.height, photo.width, CV_8U);
  bool any_object = false, any_background = false;
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) {
      std::uint8_t label = cv::GC_PR_BGD;
      const float difference = *evidence.difference.At(x, y);
      if (difference >= 0.0f) {
        label = LabelOnMat(difference, *evidence.pattern.At(x, y), !evidence.albedo.empty());
      } else if (!hull.empty() && *hull.At(x, y) >= 0.5f) {
        label = cv::GC_PR_FGD;
      }
      if (!grown.empty() && grown.at<std::uint8_t>(y, x) == 0) label = cv::GC_BGD;
      labels.at<std::uint8_t>(y, x) = label;
      any_object |= label == cv::GC_FGD || label == cv::GC_PR_FGD;
      any_background |= label == cv::GC_BGD || label == cv::GC_PR_BGD;
    }
  }
  cv::Mat inside(photo.height, photo.width, CV_8U, cv::Scalar(0));
  if (any_object && any_background) {
    const cv::Mat source(photo.height, photo.width, CV_8UC(photo.channels),
                         const_cast<std::uint8_t*>(photo.pixels.data()));
    cv::Mat rgb = source;
    if (photo.channels == 4) cv::cvtColor(source, rgb, cv::COLOR_RGBA2RGB);
    cv::Mat background, object;
    cv::setRNGSeed(kSeed);  // of this thread: the same photo gives the same mask
    cv::grabCut(rgb, labels, {}, background, object, kIterations, cv::GC_INIT_WITH_MASK);
    for (int y = 0; y < photo.height; ++y) {
      for (int x = 0; x < photo.width; ++x) {
        inside.at<std::uint8_t>(y, x) = labels.at<std::uint8_t>(y, x) & 1;
      }
    }
    KeepObjectRegions(evidence, &inside);
  }
  if (hull.empty() || evidence.expected.pixels.empty()) return Softened(inside);
  core::FloatImage mask(photo.width, photo.height, 1);
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) *mask.At(x, y) = inside.at<std::uint8_t>(y, x);
  }
  return MatteOnMat(photo, evidence, mask);
}

core::FloatImage OpenBesideMat(const core::FloatImage& opacity, const MatEvidence& evidence) {
  core::FloatImage open = opacity;
  for (int y = 0; y < open.height; ++y) {
    for (int x = 0; x < open.width; ++x) {
      if (*evidence.difference.At(x, y) < 0.0f) *open.At(x, y) = 1.0f;
    }
  }
  return open;
}

void ClipBesideMat(const MatEvidence& evidence, const core::FloatImage& hull,
                   core::FloatImage* opacity) {
  if (hull.empty()) return;
  const cv::Mat grown = GrownHull(hull);
  for (int y = 0; y < opacity->height; ++y) {
    for (int x = 0; x < opacity->width; ++x) {
      if (*evidence.difference.At(x, y) < 0.0f && grown.at<std::uint8_t>(y, x) == 0) {
        *opacity->At(x, y) = 0.0f;
      }
    }
  }
}

core::FloatImage SilhouetteOf(const core::TriangleMesh& mesh, const core::Camera& camera) {
  core::TexturedMesh object;
  object.mesh = mesh;
  render::Scene scene;
  scene.Add(&object);
  scene.Commit();
  const render::ForwardBuffers buffers = render::RenderForward(scene, camera);
  core::FloatImage silhouette(camera.width, camera.height, 1);
  silhouette.values = buffers.mask;
  return silhouette;
}

}  // namespace simwright::capture
