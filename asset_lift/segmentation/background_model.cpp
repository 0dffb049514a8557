#include "asset_lift/segmentation/background_model.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/saliency.hpp>

#include "asset_lift/segmentation/matte_edges.h"
#include "asset_lift/segmentation/round_outline.h"
#include "core/error.h"

namespace simwright::asset_lift {
namespace {

// The distance to the border's colours, in standard deviations, below which a pixel looks like
// background.
constexpr double kAlikeColor = 3.0;

// Returns the photo in BGR at the working size, slightly smoothed: sensor noise and halftone
// screens would otherwise dominate the colour models.
cv::Mat WorkingCopy(const core::Image& photo, int side) {
  const double scale =
      std::min(1.0, static_cast<double>(side) / std::max(photo.width, photo.height));
  const core::Image small =
      core::Resize(photo, std::max(16, static_cast<int>(std::lround(photo.width * scale))),
                   std::max(16, static_cast<int>(std::lround(photo.height * scale))));
  const cv::Mat bgr = PhotoInBgr(small);
  cv::Mat smooth;
  cv::bilateralFilter(bgr, smooth, 7, 30.0, 5.0);
  return smooth;
}

// Returns each pixel's distance from the border's colours: the Mahalanobis distance to the nearest
// cluster of the CIELAB colours along the frame, where clusters spread by at least a just
// noticeable difference.
cv::Mat DistanceFromBorder(const cv::Mat& bgr, std::uint64_t seed) {
  cv::Mat lab;
  bgr.convertTo(lab, CV_32F, 1.0 / 255.0);
  cv::cvtColor(lab, lab, cv::COLOR_BGR2Lab);
  const int band = std::max(2, std::min(bgr.rows, bgr.cols) / 25);
  std::vector<cv::Vec3f> border;
  for (int y = 0; y < lab.rows; ++y) {
    for (int x = 0; x < lab.cols; ++x) {
      // The middle of the lower edge is excluded, because objects stand there; the lower corners
      // are included.
      const bool frame = x < band || y < band || x >= lab.cols - band;
      const bool below = y >= lab.rows - band && std::abs(x - lab.cols / 2) > lab.cols / 4;
      if (frame || below) border.push_back(lab.at<cv::Vec3f>(y, x));
    }
  }
  const int clusters = std::min<int>(6, static_cast<int>(border.size()));
  cv::Mat samples(static_cast<int>(border.size()), 3, CV_32F, border.data());
  cv::Mat labels, centers;
  cv::setRNGSeed(static_cast<int>(seed));
  cv::kmeans(samples, clusters, labels,
             cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.2), 3,
             cv::KMEANS_PP_CENTERS, centers);
  std::vector<cv::Vec3f> variance(static_cast<size_t>(clusters), cv::Vec3f(0, 0, 0));
  std::vector<int> count(static_cast<size_t>(clusters), 0);
  for (int i = 0; i < samples.rows; ++i) {
    const int k = labels.at<int>(i);
    ++count[static_cast<size_t>(k)];
    for (int c = 0; c < 3; ++c) {
      const float d = samples.at<float>(i, c) - centers.at<float>(k, c);
      variance[static_cast<size_t>(k)][c] += d * d;
    }
  }
  cv::Mat distance(lab.size(), CV_32F);
  for (int y = 0; y < lab.rows; ++y) {
    for (int x = 0; x < lab.cols; ++x) {
      float nearest = 1e30f;
      for (int k = 0; k < clusters; ++k) {
        // A cluster of a few pixels is the object touching the frame, not background.
        if (count[static_cast<size_t>(k)] < 0.02 * samples.rows) continue;
        float sum = 0.0f;
        for (int c = 0; c < 3; ++c) {
          const float d = lab.at<cv::Vec3f>(y, x)[c] - centers.at<float>(k, c);
          // Lightness varies with shading over one surface: it has half the weight.
          const float spread = variance[static_cast<size_t>(k)][c] /
                                   static_cast<float>(count[static_cast<size_t>(k)]) +
                               (c == 0 ? 30.0f : 8.0f);
          sum += d * d / spread;
        }
        nearest = std::min(nearest, sum);
      }
      distance.at<float>(y, x) = std::sqrt(nearest);
    }
  }
  return distance;
}

cv::Mat Saliency(const cv::Mat& bgr) {
  cv::Mat map;
  const cv::Ptr<cv::saliency::StaticSaliencyFineGrained> model =
      cv::saliency::StaticSaliencyFineGrained::create();
  if (!model->computeSaliency(bgr, map)) return cv::Mat::zeros(bgr.size(), CV_32F);
  map.convertTo(map, CV_32F);
  cv::GaussianBlur(map, map, cv::Size(), 0.02 * std::max(bgr.rows, bgr.cols));
  double high = 0.0;
  cv::minMaxLoc(map, nullptr, &high);
  return high > 0.0 ? map / high : map;
}

// Returns a prior that favours the image centre, where photographers place the object.
cv::Mat CentrePrior(const cv::Size& size) {
  cv::Mat prior(size, CV_32F);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const float dx = (static_cast<float>(x) + 0.5f) / static_cast<float>(size.width) - 0.5f;
      const float dy = (static_cast<float>(y) + 0.5f) / static_cast<float>(size.height) - 0.5f;
      prior.at<float>(y, x) = std::exp(-(dx * dx + dy * dy) / (2.0f * 0.28f * 0.28f));
    }
  }
  return prior;
}

// Returns GrabCut's initial trimap: certain background along the frame, probable foreground where
// the evidence is above Otsu's threshold, certain foreground where it is far above and central.
cv::Mat Trimap(const cv::Mat& distance, const cv::Mat& saliency) {
  cv::Mat evidence;
  cv::min(distance / 8.0, 1.0, evidence);
  evidence = 0.75 * evidence + 0.25 * saliency;
  evidence = evidence.mul(0.35 + 0.65 * CentrePrior(distance.size()));
  cv::GaussianBlur(evidence, evidence, cv::Size(), 2.0);
  cv::Mat scaled, binary;
  evidence.convertTo(scaled, CV_8U, 255.0);
  const double threshold =
      cv::threshold(scaled, binary, 0, 255, cv::THRESH_BINARY | cv::THRESH_OTSU);
  cv::morphologyEx(binary, binary, cv::MORPH_OPEN, cv::Mat::ones(5, 5, CV_8U));
  cv::morphologyEx(binary, binary, cv::MORPH_CLOSE, cv::Mat::ones(9, 9, CV_8U));
  cv::Mat trimap(distance.size(), CV_8U, cv::Scalar(cv::GC_PR_BGD));
  trimap.setTo(cv::GC_PR_FGD, binary);
  cv::Mat sure;
  cv::erode(scaled > std::min(250.0, 1.5 * threshold), sure, cv::Mat::ones(7, 7, CV_8U));
  trimap.setTo(cv::GC_FGD, sure);
  const int band = std::max(2, std::min(trimap.rows, trimap.cols) / 60);
  cv::Mat frame(trimap.size(), CV_8U, cv::Scalar(255));
  frame(cv::Rect(band, band, trimap.cols - 2 * band, trimap.rows - band)).setTo(0);
  trimap.setTo(cv::GC_BGD, frame);
  return trimap;
}

cv::Mat ForegroundOf(const cv::Mat& trimap) {
  return (trimap == cv::GC_FGD) | (trimap == cv::GC_PR_FGD);
}

// Returns the pixels that GrabCut labels background, that have the border's colours and are
// brighter than the object: shading of the object does not look like that.
cv::Mat BrightBackground(const cv::Mat& bgr, const cv::Mat& distance, const cv::Mat& foreground) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  return ~foreground & (distance < kAlikeColor) & (grey > cv::mean(grey, foreground)[0]);
}

// Runs GrabCut again between a smaller and a larger copy of the round outline. Towards the rim an
// object may be flatter than its ellipse: bright background there stays undecided.
void CompleteRound(const cv::Mat& bgr, const cv::Mat& distance, const SegmentationOptions& options,
                   cv::Mat* trimap) {
  const std::optional<cv::RotatedRect> outline =
      FitEllipseOutline(bgr, ForegroundOf(*trimap), options.seed);
  if (!outline) return;
  const auto scaled = [&](float factor) {
    return cv::RotatedRect(outline->center, outline->size * factor, outline->angle);
  };
  cv::Mat next(trimap->size(), CV_8U, cv::Scalar(cv::GC_BGD));
  cv::ellipse(next, scaled(1.06f), cv::Scalar(cv::GC_PR_BGD), -1);
  cv::ellipse(next, scaled(1.0f), cv::Scalar(cv::GC_PR_FGD), -1);
  cv::ellipse(next, scaled(0.94f), cv::Scalar(cv::GC_FGD), -1);
  next.setTo(cv::GC_PR_BGD,
             (next == cv::GC_FGD) & BrightBackground(bgr, distance, ForegroundOf(*trimap)));
  cv::ellipse(next, scaled(0.7f), cv::Scalar(cv::GC_FGD), -1);
  cv::Mat background_model, foreground_model;
  cv::grabCut(bgr, next, cv::Rect(), background_model, foreground_model, 2, cv::GC_INIT_WITH_MASK);
  *trimap = next;
}

cv::Mat FilledHoles(const cv::Mat& mask, double smallest_hole) {
  cv::Mat labels, stats, centroids, filled = mask.clone();
  const int count = cv::connectedComponentsWithStats(mask == 0, labels, stats, centroids, 4);
  for (int label = 1; label < count; ++label) {
    const int area = stats.at<int>(label, cv::CC_STAT_AREA);
    if (area < smallest_hole) filled.setTo(255, labels == label);
  }
  return filled;
}

}  // namespace

cv::Mat FindForeground(const core::Image& photo, const SegmentationOptions& options) {
  const cv::Mat bgr = WorkingCopy(photo, options.working_side);
  const cv::Mat distance = DistanceFromBorder(bgr, options.seed);
  cv::Mat trimap = Trimap(distance, Saliency(bgr));
  const int foreground = cv::countNonZero((trimap == cv::GC_PR_FGD) | (trimap == cv::GC_FGD));
  if (foreground < options.min_area * static_cast<double>(trimap.total())) {
    throw core::Error("no object stands out from the background", "",
                      "cut it out with a transparent background, or give --mask");
  }
  cv::Mat background_model, foreground_model;
  cv::setRNGSeed(static_cast<int>(options.seed));
  cv::grabCut(bgr, trimap, cv::Rect(), background_model, foreground_model,
              options.grabcut_iterations, cv::GC_INIT_WITH_MASK);
  if (options.round_object) CompleteRound(bgr, distance, options, &trimap);
  cv::Mat mask = ForegroundOf(trimap);
  const double size = 0.01 * std::max(mask.rows, mask.cols);
  const int radius = std::max(1, static_cast<int>(std::lround(size)));
  const cv::Mat disc =
      cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(2 * radius + 1, 2 * radius + 1));
  cv::morphologyEx(mask, mask, cv::MORPH_OPEN, disc);
  // Handle holes are kept; highlights and prints on the object are smaller and are filled.
  mask = FilledHoles(mask, 0.012 * cv::countNonZero(mask));
  return RefineMatte(PhotoInBgr(photo), mask, radius);
}

}  // namespace simwright::asset_lift
