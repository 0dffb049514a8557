#include "asset_lift/segmentation/segmentation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "asset_lift/segmentation/background_model.h"
#include "asset_lift/segmentation/network_foreground.h"
#include "asset_lift/segmentation/outline_contrast.h"
#include "core/error.h"

namespace simwright::asset_lift {
namespace {

constexpr const char* kDrawMask = "cut it out with a transparent background, or give --mask";

struct Regions {
  cv::Mat labels;
  std::vector<std::pair<int, int>> by_area;  // (area, label), largest first
};

Regions FindRegions(const cv::Mat& mask) {
  Regions regions;
  cv::Mat stats, centroids;
  const int count = cv::connectedComponentsWithStats(mask, regions.labels, stats, centroids, 8);
  for (int label = 1; label < count; ++label) {
    regions.by_area.emplace_back(stats.at<int>(label, cv::CC_STAT_AREA), label);
  }
  std::sort(regions.by_area.rbegin(), regions.by_area.rend());
  return regions;
}

// Returns the largest region alone. Throws if a second region is large; specks are dropped.
cv::Mat OneObject(const cv::Mat& mask, const SegmentationOptions& options) {
  const Regions regions = FindRegions(mask);
  const double pixels = static_cast<double>(mask.total());
  if (regions.by_area.empty() || regions.by_area[0].first < options.min_area * pixels) {
    throw core::Error("no object stands out in the photo", "", kDrawMask);
  }
  if (regions.by_area.size() > 1 &&
      regions.by_area[1].first > options.second_object * regions.by_area[0].first) {
    throw core::Error("the photo shows two objects or more", "", "crop it to one, or give --mask");
  }
  if (regions.by_area[0].first > options.max_area * pixels) {
    throw core::Error("the object fills the whole photo: there is no background around it", "",
                      "take it from farther away, or give --mask");
  }
  return regions.labels == regions.by_area[0].second;
}

// Throws where much of the outline has no contrast, as for a segment of an empty table or of a
// transparent object.
void RequireOutline(const core::Image& photo, const cv::Mat& object,
                    const SegmentationOptions& options) {
  const double weak = WeakOutlineShare(photo, object);
  if (weak <= options.max_weak_outline) return;
  throw core::Error(
      "no object stands out from the background: " + std::to_string(std::lround(100.0 * weak)) +
          " % of the candidate outline looks the same on both sides, as for an "
          "empty table or for clear glass",
      "", "take it before another background, or give --mask");
}

// Throws if there is a smaller second object. The contrast of its outline distinguishes it from a
// reflection or a shadow.
void RequireAlone(const core::Image& photo, const cv::Mat& mask,
                  const SegmentationOptions& options) {
  const Regions regions = FindRegions(mask);
  for (size_t i = 1; i < regions.by_area.size(); ++i) {
    const auto [area, label] = regions.by_area[i];
    if (area < options.second_outlined * regions.by_area[0].first) return;
    if (WeakOutlineShare(photo, regions.labels == label) > options.max_weak_outline) continue;
    throw core::Error("the photo shows two objects or more, the second " +
                          std::to_string(std::lround(100.0 * area / regions.by_area[0].first)) +
                          " % as large as the first",
                      "", "crop it to one, or give --mask");
  }
}

Matte LargeEnough(Matte matte, const SegmentationOptions& options) {
  const int width = matte.right - matte.left, height = matte.bottom - matte.top;
  if (std::max(width, height) >= options.min_side) return matte;
  throw core::Error(
      "the object is only " + std::to_string(width) + " x " + std::to_string(height) + " pixels",
      "", "use a photo that shows it at least 64 pixels large");
}

// Returns the share of the border that the mask covers, per side: left, top, right, bottom.
std::array<double, 4> BorderShares(const cv::Mat& mask) {
  const auto share = [](const cv::Mat& line) {
    return static_cast<double>(cv::countNonZero(line)) / static_cast<double>(line.total());
  };
  return {share(mask.col(0)), share(mask.row(0)), share(mask.col(mask.cols - 1)),
          share(mask.row(mask.rows - 1))};
}

void RequireWellFormed(const cv::Mat& mask) {
  int cut = 0;
  for (const double share : BorderShares(mask)) cut += share > 0.25;
  if (cut >= 2) {
    throw core::Error("the object is cut off at the photo's edges, or does not stand out", "",
                      kDrawMask);
  }
}

Matte MatteFrom(const cv::Mat& alpha, const std::string& method) {
  Matte matte;
  matte.method = method;
  matte.alpha = core::Image(alpha.cols, alpha.rows, 1);
  for (int y = 0; y < alpha.rows; ++y) std::copy_n(alpha.ptr(y), alpha.cols, matte.alpha.At(0, y));
  const cv::Mat inside = alpha > 127;
  const cv::Rect box = cv::boundingRect(inside);
  matte.left = box.x;
  matte.top = box.y;
  matte.right = box.x + box.width;
  matte.bottom = box.y + box.height;
  matte.area = cv::countNonZero(inside) / static_cast<double>(inside.total());
  return matte;
}

cv::Mat Channel(const core::Image& image, int channel) {
  cv::Mat plane(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) plane.at<uchar>(y, x) = image.At(x, y)[channel];
  }
  return plane;
}

bool HasCutOut(const core::Image& photo) {
  if (photo.channels != 4) return false;
  for (size_t i = 3; i < photo.pixels.size(); i += 4) {
    if (photo.pixels[i] < 128) return true;
  }
  return false;
}

Matte FromAlpha(const core::Image& photo, const SegmentationOptions& options) {
  const cv::Mat alpha = Channel(photo, 3);
  if (cv::countNonZero(alpha > 127) == 0) {
    throw core::Error("the photo is transparent everywhere", "", "export it with its object");
  }
  SegmentationOptions whole = options;
  whole.max_area = 1.0;  // a cut-out may fill its frame
  const cv::Mat object = OneObject(alpha > 127, whole);
  cv::Mat kept;
  cv::Mat grown;
  cv::dilate(object, grown, cv::Mat::ones(5, 5, CV_8U));
  alpha.copyTo(kept, grown);
  return MatteFrom(kept, "alpha channel");
}

Matte FromMask(const core::Image& photo, const core::Image& mask,
               const SegmentationOptions& options) {
  const double proportion = static_cast<double>(mask.width) * photo.height /
                            (static_cast<double>(mask.height) * photo.width);
  if (std::abs(proportion - 1.0) > 0.02) {
    throw core::Error("the mask is " + std::to_string(mask.width) + " x " +
                          std::to_string(mask.height) + " pixels and the photo " +
                          std::to_string(photo.width) + " x " + std::to_string(photo.height),
                      "", "make the mask at the photo's aspect ratio");
  }
  const core::Image fitted = core::Resize(mask, photo.width, photo.height);
  cv::Mat bright = Channel(fitted, fitted.channels == 4 ? 3 : 0);
  if (fitted.channels == 4 && cv::countNonZero(bright < 128) == 0) bright = Channel(fitted, 0);
  SegmentationOptions given = options;
  given.max_area = 1.0;
  const cv::Mat object = OneObject(bright > 127, given);
  cv::Mat kept;
  bright.copyTo(kept, object);
  return MatteFrom(kept, "given mask");
}

cv::Mat WithoutOtherRegions(const cv::Mat& alpha, const cv::Mat& object) {
  cv::Mat grown, kept;
  cv::dilate(object, grown, cv::Mat::ones(5, 5, CV_8U));
  alpha.copyTo(kept, grown);
  return kept;
}

// The contrast of the outline is not checked: a network also recognises a white mug on a white
// table.
Matte FromNetwork(const core::Image& photo, const SegmentationOptions& options) {
  const cv::Mat alpha = FindForegroundByNetwork(photo, options.network.get(), options);
  const cv::Mat object = OneObject(alpha > 127, options);
  RequireWellFormed(object);
  return MatteFrom(WithoutOtherRegions(alpha, object), "the network " + options.network->name());
}

}  // namespace

Matte SegmentObject(const core::Image& photo, const std::optional<core::Image>& mask,
                    const SegmentationOptions& options) {
  if (photo.width < 16 || photo.height < 16) {
    throw core::Error("the photo is only " + std::to_string(photo.width) + " x " +
                          std::to_string(photo.height) + " pixels",
                      "", "use one of at least 64 pixels per side");
  }
  if (mask) return LargeEnough(FromMask(photo, *mask, options), options);
  if (HasCutOut(photo)) return LargeEnough(FromAlpha(photo, options), options);
  if (options.network != nullptr) return LargeEnough(FromNetwork(photo, options), options);
  const cv::Mat alpha = FindForeground(photo, options);
  const cv::Mat object = OneObject(alpha > 127, options);
  RequireOutline(photo, object, options);
  RequireAlone(photo, alpha > 127, options);
  RequireWellFormed(object);
  return LargeEnough(MatteFrom(WithoutOtherRegions(alpha, object), "colour and contrast"), options);
}

}  // namespace simwright::asset_lift
