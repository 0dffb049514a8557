#include "asset_lift/segmentation/network_foreground.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/ximgproc/edge_filter.hpp>

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
  cv::Mat bgr(small.height, small.width, CV_8UC3);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      const std::uint8_t* p = small.At(x, y);
      const bool grey = small.channels < 3;
      bgr.at<cv::Vec3b>(y, x) = {p[grey ? 0 : 2], p[grey ? 0 : 1], p[0]};
    }
  }
  return bgr;
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

// Returns `mask` (255 inside) as a soft matte of the size `photo`, with the edges of `bgr`, which
// move by at most 2 pixels.
cv::Mat RefinedEdges(const cv::Mat& bgr, const cv::Mat& mask, const cv::Size& photo) {
  constexpr int kRadius = 2;
  // In 8-bit units. With values in [0, 1], OpenCV 4.6 treats the covariance of a guide as singular
  // and returns the box mean, in which thin parts vanish.
  constexpr double kEpsilon = 1e-3 * 255.0 * 255.0;
  cv::Mat guided, inside, outside, full;
  cv::ximgproc::guidedFilter(bgr, mask, guided, 2 * kRadius, kEpsilon);
  const cv::Mat disc = BandElement(kRadius);
  cv::erode(mask, inside, disc);
  cv::dilate(mask, outside, disc);
  guided.setTo(255, inside);
  guided.setTo(0, outside == 0);
  cv::resize(guided, full, photo, 0, 0, cv::INTER_LINEAR);
  return full;
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
  return RefinedEdges(bgr, GrabCutForeground(trimap), cv::Size(photo.width, photo.height));
}

}  // namespace simwright::asset_lift
