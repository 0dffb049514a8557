#include "asset_lift/segmentation/box_matte.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace simwright::asset_lift {
namespace {

constexpr double kBoxSurroundings = 0.35;  // of the box's sides, around it, for the background
constexpr int kBoxIterations = 5;
constexpr double kLeastFilled = 0.15;  // of the box
constexpr int kLeastBoxSide = 4;       // pixels

}  // namespace

core::Image BoxMatte(const core::Image& photo, const Eigen::AlignedBox2d& box, int working_side) {
  const cv::Rect whole(0, 0, photo.width, photo.height);
  const cv::Rect inside = whole & cv::Rect(cv::Point(static_cast<int>(std::floor(box.min().x())),
                                                     static_cast<int>(std::floor(box.min().y()))),
                                           cv::Point(static_cast<int>(std::ceil(box.max().x())),
                                                     static_cast<int>(std::ceil(box.max().y()))));
  if (photo.channels != 3 || inside.width < kLeastBoxSide || inside.height < kLeastBoxSide) {
    throw core::Error("a box covers less than 4 pixels a side of the photo");
  }
  const int dx = static_cast<int>(kBoxSurroundings * inside.width) + 4;
  const int dy = static_cast<int>(kBoxSurroundings * inside.height) + 4;
  const cv::Rect around =
      whole & cv::Rect(inside.x - dx, inside.y - dy, inside.width + 2 * dx, inside.height + 2 * dy);
  const cv::Mat rgb(photo.height, photo.width, CV_8UC3,
                    const_cast<std::uint8_t*>(photo.pixels.data()));
  const double scale =
      std::min(1.0, static_cast<double>(working_side) / std::max(inside.width, inside.height));
  cv::Mat crop;
  cv::resize(rgb(around), crop, {}, scale, scale, cv::INTER_AREA);
  const auto scaled = [&](double value) { return static_cast<int>(std::lround(value * scale)); };
  cv::Rect seed(scaled(inside.x - around.x), scaled(inside.y - around.y),
                std::max(2, scaled(inside.width)), std::max(2, scaled(inside.height)));
  seed &= cv::Rect(0, 0, crop.cols, crop.rows);
  cv::Mat labels(crop.size(), CV_8UC1, cv::Scalar(cv::GC_BGD));
  labels(seed).setTo(cv::GC_PR_FGD);
  // A box that fills its surroundings leaves no background to learn from.
  if (seed.area() < crop.cols * crop.rows) {
    cv::setRNGSeed(1);
    cv::Mat background, foreground;
    cv::grabCut(crop, labels, seed, background, foreground, kBoxIterations, cv::GC_INIT_WITH_MASK);
  }
  cv::Mat mask = ((labels == cv::GC_FGD) | (labels == cv::GC_PR_FGD));
  if (cv::countNonZero(mask) < kLeastFilled * seed.area()) {
    mask.setTo(0);
    cv::ellipse(
        mask,
        cv::RotatedRect(cv::Point2f(static_cast<float>(seed.x + 0.5 * seed.width),
                                    static_cast<float>(seed.y + 0.5 * seed.height)),
                        cv::Size2f(static_cast<float>(seed.width), static_cast<float>(seed.height)),
                        0.0f),
        cv::Scalar(255), cv::FILLED);
  }
  cv::Mat full;
  cv::resize(mask, full, around.size(), 0, 0, cv::INTER_LINEAR);
  core::Image matte(photo.width, photo.height, 1);
  cv::Mat target(photo.height, photo.width, CV_8UC1, matte.pixels.data());
  full.copyTo(target(around));
  return matte;
}

}  // namespace simwright::asset_lift
