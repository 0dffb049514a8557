#include "asset_lift/segmentation/mask_refinement.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace simwright::asset_lift {
namespace {

constexpr double kAroundMask = 0.4;   // of the mask's sides: the surroundings that are seen
constexpr double kBandOutside = 0.1;  // of the mask's mean side, around the outline
constexpr double kBandInside = 0.16;  // the same, inside
constexpr int kRefinementIterations = 3;
constexpr double kLeastCommon = 0.5;  // IoU of the answer with the mask
constexpr int kMaskInside = 128;

cv::Mat MatOf(const core::Image& image) {
  return {image.height, image.width, image.channels == 3 ? CV_8UC3 : CV_8UC1,
          const_cast<std::uint8_t*>(image.pixels.data())};
}

cv::Mat BandElement(double radius) {
  const int side = 2 * std::max(1, static_cast<int>(std::lround(radius))) + 1;
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side});
}

// Returns GrabCut's first labels: the band is open, the rest is sure.
cv::Mat FirstLabels(const cv::Mat& mask, const cv::Mat& others) {
  const double side = std::sqrt(static_cast<double>(cv::countNonZero(mask)));
  cv::Mat wide, core;
  cv::dilate(mask, wide, BandElement(kBandOutside * side + 1.0));
  cv::erode(mask, core, BandElement(kBandInside * side), {-1, -1}, 1, cv::BORDER_CONSTANT,
            cv::Scalar(255));
  cv::Mat labels(mask.size(), CV_8UC1, cv::Scalar(cv::GC_BGD));
  labels.setTo(cv::GC_PR_BGD, wide);
  labels.setTo(cv::GC_PR_FGD, mask);
  labels.setTo(cv::GC_FGD, core);
  labels.setTo(cv::GC_BGD, others & ~mask);
  return labels;
}

double CommonShare(const cv::Mat& a, const cv::Mat& b) {
  return cv::countNonZero(a & b) / std::max(1.0, static_cast<double>(cv::countNonZero(a | b)));
}

}  // namespace

core::Image RefinedMask(const core::Image& photo, const core::Image& mask,
                        const core::Image& others, int working_side) {
  if (photo.channels != 3 || mask.channels != 1 || others.channels != 1 ||
      mask.width != photo.width || mask.height != photo.height || others.width != photo.width ||
      others.height != photo.height) {
    throw core::Error("masks must have one channel and the size of their RGB photo");
  }
  const cv::Mat rough = MatOf(mask) >= kMaskInside;
  const cv::Rect box = cv::boundingRect(rough);
  if (box.area() == 0) return mask;
  const int reach = static_cast<int>(kAroundMask * std::max(box.width, box.height)) + 6;
  const cv::Rect around =
      cv::Rect(0, 0, photo.width, photo.height) &
      cv::Rect(box.x - reach, box.y - reach, box.width + 2 * reach, box.height + 2 * reach);
  const double scale =
      std::min(1.0, static_cast<double>(working_side) / std::max(box.width, box.height));
  cv::Mat crop, small, blocked;
  cv::resize(MatOf(photo)(around), crop, {}, scale, scale, cv::INTER_AREA);
  cv::resize(rough(around), small, crop.size(), 0, 0, cv::INTER_AREA);
  cv::resize(MatOf(others)(around), blocked, crop.size(), 0, 0, cv::INTER_AREA);
  small = small >= kMaskInside;
  cv::Mat labels = FirstLabels(small, blocked >= kMaskInside);
  const cv::Mat sure = labels == cv::GC_BGD;
  if (cv::countNonZero(small) < 8 || cv::countNonZero(sure) < 8) return mask;
  cv::setRNGSeed(1);
  cv::Mat background, foreground;
  cv::grabCut(crop, labels, {}, background, foreground, kRefinementIterations,
              cv::GC_INIT_WITH_MASK);
  const cv::Mat found = (labels == cv::GC_FGD) | (labels == cv::GC_PR_FGD);
  if (CommonShare(found, small) < kLeastCommon) return mask;
  cv::Mat full;
  cv::resize(found, full, around.size(), 0, 0, cv::INTER_LINEAR);
  core::Image refined(photo.width, photo.height, 1);
  full.copyTo(cv::Mat(photo.height, photo.width, CV_8UC1, refined.pixels.data())(around));
  return refined;
}

}  // namespace simwright::asset_lift
