#include "twin/detection_mask.h"

#include <utility>

namespace simwright::twin {
namespace {

constexpr int kMaskInside = 128;
constexpr double kBorderReach = 2.0;  // pixels

}  // namespace

Detection DetectionOfMask(core::Image mask) {
  Detection detection;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (*mask.At(x, y) < kMaskInside) continue;
      detection.box.extend(Eigen::Vector2d(x, y));
      detection.box.extend(Eigen::Vector2d(x + 1, y + 1));
    }
  }
  detection.confidence = 1.0;
  detection.cut = detection.box.min().x() < kBorderReach ||
                  detection.box.min().y() < kBorderReach ||
                  detection.box.max().x() > mask.width - kBorderReach ||
                  detection.box.max().y() > mask.height - kBorderReach;
  detection.alpha = std::move(mask);
  return detection;
}

}  // namespace simwright::twin
