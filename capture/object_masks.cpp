#include "capture/object_masks.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "capture/mat_cut.h"
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
constexpr double kLeastInHull = 0.8;     // share of a region beside the mat that the hull shows
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

// Removes regions that are small against the largest one. Where one lies before the mat, those that
// lie wholly beside it are background, unless the hull (empty: unknown) shows them.
void KeepObjectRegions(const MatEvidence& evidence, const core::FloatImage& hull, cv::Mat* inside) {
  cv::Mat regions, stats, centers;
  const int count = cv::connectedComponentsWithStats(*inside, regions, stats, centers, 8);
  std::vector<char> before_mat(static_cast<std::size_t>(count), 0);
  std::vector<int> in_hull(before_mat.size(), 0);
  for (int y = 0; y < inside->rows; ++y) {
    for (int x = 0; x < inside->cols; ++x) {
      const auto region = static_cast<std::size_t>(regions.at<int>(y, x));
      if (*evidence.difference.At(x, y) >= 0.0f) before_mat[region] = 1;
      if (!hull.empty() && *hull.At(x, y) >= 0.5f) ++in_hull[region];
    }
  }
  const bool any_before =
      std::find(before_mat.begin() + 1, before_mat.end(), 1) != before_mat.end();
  const auto may_stay = [&](int region) {
    const auto at = static_cast<std::size_t>(region);
    return !any_before || before_mat[at] != 0 ||
           in_hull[at] >= kLeastInHull * stats.at<int>(region, cv::CC_STAT_AREA);
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

// Returns GrabCut's labels (cv::GC_*) of the pixels before any cut.
cv::Mat FirstLabels(const MatEvidence& evidence, const core::FloatImage& hull) {
  const cv::Mat grown = GrownHull(hull);
  cv::Mat labels(evidence.difference.height, evidence.difference.width, CV_8U);
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      std::uint8_t label = cv::GC_PR_BGD;
      const float difference = *evidence.difference.At(x, y);
      if (difference >= 0.0f) {
        label = LabelOnMat(difference, *evidence.pattern.At(x, y), !evidence.albedo.empty());
      } else if (!hull.empty() && *hull.At(x, y) >= 0.5f) {
        label = cv::GC_PR_FGD;
      }
      if (!grown.empty() && grown.at<std::uint8_t>(y, x) == 0) label = cv::GC_BGD;
      labels.at<std::uint8_t>(y, x) = label;
    }
  }
  return labels;
}

std::vector<CutLabel> CutLabels(const cv::Mat& labels) {
  std::vector<CutLabel> result;
  for (auto label = labels.begin<std::uint8_t>(); label != labels.end<std::uint8_t>(); ++label) {
    result.push_back(*label == cv::GC_BGD      ? CutLabel::kBackground
                     : *label == cv::GC_FGD    ? CutLabel::kObject
                     : *label == cv::GC_PR_FGD ? CutLabel::kLikelyObject
                                               : CutLabel::kLikelyBackground);
  }
  return result;
}

// Returns 1 for the pixels that GrabCut finds to be the object.
cv::Mat GrabbedObject(const core::Image& photo, cv::Mat labels) {
  const cv::Mat source(photo.height, photo.width, CV_8UC(photo.channels),
                       const_cast<std::uint8_t*>(photo.pixels.data()));
  cv::Mat rgb = source;
  if (photo.channels == 4) cv::cvtColor(source, rgb, cv::COLOR_RGBA2RGB);
  cv::Mat background, object;
  cv::setRNGSeed(kSeed);  // of this thread: the same photo gives the same mask
  cv::grabCut(rgb, labels, {}, background, object, kIterations, cv::GC_INIT_WITH_MASK);
  return labels & 1;
}

}  // namespace

ObjectMask SegmentOnMat(const core::Image& photo, const MatEvidence& evidence,
                        const core::FloatImage& hull, const ColorMixture* others) {
  if (evidence.difference.width != photo.width || evidence.difference.height != photo.height ||
      (!hull.empty() && (hull.width != photo.width || hull.height != photo.height))) {
    throw core::Error("photo, mat and hull differ in size", "segmentation on the mat");
  }
  const cv::Mat labels = FirstLabels(evidence, hull);
  const int objects = cv::countNonZero(labels & 1);  // certain or not
  ObjectMask result;
  cv::Mat inside(photo.height, photo.width, CV_8U, cv::Scalar(0));
  const bool on_table = evidence.albedo.empty() || evidence.expected.pixels.empty();
  // GrabCut learns both colours from the labels.
  if (!on_table || (objects > 0 && objects < photo.width * photo.height)) {
    if (on_table) {
      inside = GrabbedObject(photo, labels);
    } else {
      MatCut cut = CutFromMat(photo, evidence, CutLabels(labels), others);
      for (int y = 0; y < photo.height; ++y) {
        for (int x = 0; x < photo.width; ++x) {
          inside.at<std::uint8_t>(y, x) = *cut.inside.At(x, y) > 0.0f;
        }
      }
      result.unsure = std::move(cut.unsure);
    }
    KeepObjectRegions(evidence, hull, &inside);
  }
  if (hull.empty() || evidence.expected.pixels.empty()) {
    result.opacity = Softened(inside);
    return result;
  }
  core::FloatImage mask(photo.width, photo.height, 1);
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) *mask.At(x, y) = inside.at<std::uint8_t>(y, x);
  }
  result.opacity = MatteOnMat(photo, evidence, mask);
  return result;
}

std::vector<Eigen::Vector3f> ColorsBeforeMat(const core::Image& photo, const MatEvidence& evidence,
                                             const ObjectMask& mask) {
  std::vector<Eigen::Vector3f> colors;
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) {
      if (*mask.opacity.At(x, y) < 0.99f || *evidence.difference.At(x, y) < kLikelyMat) continue;
      if (!mask.unsure.empty() && *mask.unsure.At(x, y) > 0.0f) continue;
      const std::uint8_t* pixel = photo.At(x, y);
      colors.emplace_back(pixel[0], pixel[1], pixel[2]);
    }
  }
  return colors;
}

core::FloatImage PixelsBesideMat(const MatEvidence& evidence) {
  core::FloatImage beside(evidence.difference.width, evidence.difference.height, 1);
  for (std::size_t i = 0; i < beside.values.size(); ++i) {
    beside.values[i] = evidence.difference.values[i] < 0.0f;
  }
  return beside;
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
