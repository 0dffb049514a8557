#include "asset_lift/segmentation/network_foreground.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "asset_lift/segmentation/matte_edges.h"
#include "core/error.h"

namespace simwright::asset_lift {
namespace {

// The longer side (pixels) at which the outline is refined: larger than for colour models alone,
// since thin parts of a few pixels are to be kept.
constexpr int kRefinementSide = 800;
// The probabilities beyond which the network is certain.
constexpr double kCertainInside = 0.9, kCertainOutside = 0.1;

cv::Mat SmallBgr(const core::Image& photo) {
  const double scale =
      std::min(1.0, static_cast<double>(kRefinementSide) / std::max(photo.width, photo.height));
  const core::Image small =
      core::Resize(photo, std::max(16, static_cast<int>(std::lround(photo.width * scale))),
                   std::max(16, static_cast<int>(std::lround(photo.height * scale))));
  return PhotoInBgr(small);
}

cv::Mat BandElement(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(2 * radius + 1, 2 * radius + 1));
}

// Returns GrabCut's trimap. The certain regions keep a distance of `band` pixels from the network's
// outline, because its pixels are coarser than the photo's.
cv::Mat TrimapOf(const cv::Mat& saliency, int band) {
  cv::Mat trimap(saliency.size(), CV_8U, cv::Scalar(cv::GC_PR_BGD));
  trimap.setTo(cv::GC_PR_FGD, saliency > 0.5);
  cv::Mat inside, outside;
  cv::erode(saliency > kCertainInside, inside, BandElement(band));
  cv::erode(saliency < kCertainOutside, outside, BandElement(band));
  trimap.setTo(cv::GC_FGD, inside);
  trimap.setTo(cv::GC_BGD, outside);
  return trimap;
}

cv::Mat GrabCutForeground(const cv::Mat& trimap) {
  return (trimap == cv::GC_FGD) | (trimap == cv::GC_PR_FGD);
}

bool HasLabel(const cv::Mat& trimap, int label) {
  return cv::countNonZero(trimap == label) > 0;
}

}  // namespace

cv::Mat FindForegroundByNetwork(const core::Image& photo, SalientNetwork* network,
                                const SegmentationOptions& options) {
  const SaliencyMap map = network->Predict(photo);
  const cv::Mat coarse(map.height, map.width, CV_32F, const_cast<float*>(map.values.data()));
  const cv::Mat bgr = SmallBgr(photo);
  cv::Mat saliency;
  cv::resize(coarse, saliency, bgr.size(), 0, 0, cv::INTER_LINEAR);
  const double share = cv::countNonZero(saliency > 0.5) / static_cast<double>(saliency.total());
  if (share < options.min_area) {
    throw core::Error("the network " + network->name() + " sees no object in the photo", "",
                      "try it without --segmenter, or give --mask");
  }
  const double coarseness = std::max(static_cast<double>(bgr.cols) / map.width,
                                     static_cast<double>(bgr.rows) / map.height);
  const int band = std::max(1, static_cast<int>(std::lround(coarseness)));
  cv::Mat trimap = TrimapOf(saliency, band);
  const bool undecided = HasLabel(trimap, cv::GC_PR_FGD) || HasLabel(trimap, cv::GC_PR_BGD);
  const bool both = HasLabel(trimap, cv::GC_FGD) && HasLabel(trimap, cv::GC_BGD);
  if (undecided && both) {
    cv::Mat background_model, foreground_model;
    cv::setRNGSeed(static_cast<int>(options.seed));
    cv::grabCut(bgr, trimap, cv::Rect(), background_model, foreground_model,
                options.grabcut_iterations, cv::GC_INIT_WITH_MASK);
  }
  constexpr int kReach = 2;
  return RefineMatte(PhotoInBgr(photo), GrabCutForeground(trimap), kReach);
}

}  // namespace simwright::asset_lift
