#include "proposals/uncluttered_test.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <Eigen/Dense>

#include "asset_lift/segmentation/segmentation.h"
#include "core/error.h"

namespace simwright::proposals {
namespace {

constexpr std::uint8_t kInObject = 128;
constexpr int kTestedSide = 512;  // pixels: larger pictures are scaled down for the test
constexpr int kMargin = 6;        // pixels between the object and the background that is judged

std::string RefusalText(const char* format, double value, double limit) {
  char text[160];
  std::snprintf(text, sizeof(text), format, value, limit);
  return text;
}

double BorderShare(const core::Image& alpha) {
  int touched = 0;
  for (int x = 0; x < alpha.width; ++x) {
    touched += (*alpha.At(x, 0) >= kInObject) + (*alpha.At(x, alpha.height - 1) >= kInObject);
  }
  for (int y = 1; y + 1 < alpha.height; ++y) {
    touched += (*alpha.At(0, y) >= kInObject) + (*alpha.At(alpha.width - 1, y) >= kInObject);
  }
  return touched / (2.0 * (alpha.width + alpha.height) - 4.0);
}

// Returns the area of the second largest component of the matte over that of the largest.
double SecondComponent(const core::Image& alpha) {
  std::vector<char> done(alpha.pixels.size(), 0);
  std::vector<int> stack;
  double first = 0.0, second = 0.0;
  for (std::size_t start = 0; start < alpha.pixels.size(); ++start) {
    if (done[start] || alpha.pixels[start] < kInObject) continue;
    double area = 0.0;
    stack.assign(1, static_cast<int>(start));
    done[start] = 1;
    while (!stack.empty()) {
      const int at = stack.back();
      stack.pop_back();
      area += 1.0;
      const int x = at % alpha.width, y = at / alpha.width;
      constexpr int kDx[] = {1, -1, 0, 0}, kDy[] = {0, 0, 1, -1};
      for (int k = 0; k < 4; ++k) {
        const int nx = x + kDx[k], ny = y + kDy[k];
        if (nx < 0 || ny < 0 || nx >= alpha.width || ny >= alpha.height) continue;
        const int other = ny * alpha.width + nx;
        const auto o = static_cast<std::size_t>(other);
        if (done[o] || alpha.pixels[o] < kInObject) continue;
        done[o] = 1;
        stack.push_back(other);
      }
    }
    second = std::max(second, std::min(first, area));
    first = std::max(first, area);
  }
  return first > 0.0 ? second / first : 0.0;
}

// Returns the RMS of the background's colours about a plane per channel.
double Unevenness(const core::Image& picture, const core::Image& alpha) {
  std::vector<Eigen::Vector3d> places, colors;
  const auto near_object = [&](int x, int y) {
    for (int v = std::max(0, y - kMargin); v <= std::min(alpha.height - 1, y + kMargin); v += 3) {
      for (int u = std::max(0, x - kMargin); u <= std::min(alpha.width - 1, x + kMargin); u += 3) {
        if (*alpha.At(u, v) >= kInObject) return true;
      }
    }
    return false;
  };
  for (int y = 0; y < picture.height; y += 2) {
    for (int x = 0; x < picture.width; x += 2) {
      if (near_object(x, y)) continue;
      places.emplace_back(1.0, static_cast<double>(x) / picture.width,
                          static_cast<double>(y) / picture.height);
      const std::uint8_t* p = picture.At(x, y);
      colors.emplace_back(p[0] / 255.0, p[picture.channels < 3 ? 0 : 1] / 255.0,
                          p[picture.channels < 3 ? 0 : 2] / 255.0);
    }
  }
  if (places.size() < 10) return 0.0;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero(), products = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < places.size(); ++i) {
    squares += places[i] * places[i].transpose();
    products += places[i] * colors[i].transpose();
  }
  const Eigen::Matrix3d plane =
      (squares + 1e-9 * Eigen::Matrix3d::Identity()).ldlt().solve(products);
  double sum = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    sum += (colors[i] - plane.transpose() * places[i]).squaredNorm() / 3.0;
  }
  return std::sqrt(sum / static_cast<double>(places.size()));
}

core::Image Tested(const core::Image& picture) {
  const int longer = std::max(picture.width, picture.height);
  if (longer <= kTestedSide) return picture;
  const auto scaled = [&](int side) { return std::max(1, side * kTestedSide / longer); };
  return core::Resize(picture, scaled(picture.width), scaled(picture.height));
}

}  // namespace

UnclutteredResult TestUncluttered(const core::Image& original, std::uint64_t seed,
                                  const UnclutteredLimits& limits) {
  const core::Image picture = Tested(original);
  UnclutteredResult result;
  asset_lift::Matte matte;
  asset_lift::SegmentationOptions options;
  options.seed = seed;
  try {
    matte = asset_lift::SegmentObject(picture, std::nullopt, options);
  } catch (const core::Error& error) {
    result.reason = error.what();
    return result;
  }
  result.area = matte.area;
  result.border = BorderShare(matte.alpha);
  result.second = SecondComponent(matte.alpha);
  result.unevenness = Unevenness(picture, matte.alpha);
  if (result.area < limits.least_area) {
    result.reason = RefusalText("the object covers %.3g of the picture, less than %.3g",
                                result.area, limits.least_area);
  } else if (result.area > limits.largest_area) {
    result.reason = RefusalText("the object covers %.3g of the picture, more than %.3g",
                                result.area, limits.largest_area);
  } else if (result.border > limits.most_border) {
    result.reason = RefusalText("the object touches %.3g of the border, more than %.3g",
                                result.border, limits.most_border);
  } else if (result.second > limits.second_component) {
    result.reason = RefusalText("a second object has %.3g of the area of the first, more than %.3g",
                                result.second, limits.second_component);
  } else if (result.unevenness > limits.most_unevenness) {
    result.reason = RefusalText("the background is uneven by %.3g, more than %.3g",
                                result.unevenness, limits.most_unevenness);
  }
  result.kept = result.reason.empty();
  return result;
}

}  // namespace simwright::proposals
