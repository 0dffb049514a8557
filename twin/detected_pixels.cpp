#include "twin/detected_pixels.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace simwright::twin {
namespace {

constexpr float kInside = 0.5f;      // probability from which a pixel shows an object
constexpr float kLeastHeat = 0.25f;  // of a peak
constexpr int kPeakReach = 2;        // pixels: a peak is the largest within
constexpr float kFarthest = 40.0f;   // pixels from where an offset points to its centre
constexpr int kLeastGroup = 10;      // pixels

struct Peak {
  Eigen::Vector2f at;
  float heat = 0.0f;
};

std::vector<Peak> FindPeaks(const DetectedPixels& pixels) {
  std::vector<Peak> peaks;
  const auto heat = [&](int x, int y) {
    return pixels.centre[static_cast<size_t>(y) * pixels.width + x];
  };
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      const float value = heat(x, y);
      if (value < kLeastHeat) continue;
      bool largest = true;
      for (int dy = -kPeakReach; dy <= kPeakReach && largest; ++dy) {
        for (int dx = -kPeakReach; dx <= kPeakReach && largest; ++dx) {
          const int nx = x + dx, ny = y + dy;
          if ((dx == 0 && dy == 0) || nx < 0 || ny < 0 || nx >= pixels.width ||
              ny >= pixels.height) {
            continue;
          }
          // The last of equal neighbours is the peak.
          const bool later = dy > 0 || (dy == 0 && dx > 0);
          largest = later ? heat(nx, ny) < value : heat(nx, ny) <= value;
        }
      }
      if (largest) peaks.push_back({Eigen::Vector2f(x, y), value});
    }
  }
  return peaks;
}

}  // namespace

PixelGroups GroupPixels(const DetectedPixels& pixels) {
  const std::vector<Peak> peaks = FindPeaks(pixels);
  PixelGroups groups;
  groups.group.assign(pixels.object.size(), -1);
  std::vector<int> count(peaks.size(), 0);
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      const size_t at = static_cast<size_t>(y) * pixels.width + x;
      if (pixels.object[at] < kInside) continue;
      const Eigen::Vector2f to = Eigen::Vector2f(x, y) + pixels.offset[at];
      float nearest = kFarthest * kFarthest;
      for (size_t k = 0; k < peaks.size(); ++k) {
        const float squares = (peaks[k].at - to).squaredNorm();
        if (squares >= nearest) continue;
        nearest = squares;
        groups.group[at] = static_cast<int>(k);
      }
      if (groups.group[at] >= 0) ++count[static_cast<size_t>(groups.group[at])];
    }
  }
  std::vector<int> kept(peaks.size(), -1);
  for (size_t k = 0; k < peaks.size(); ++k) {
    if (count[k] < kLeastGroup) continue;
    kept[k] = static_cast<int>(groups.centre.size());
    groups.centre.push_back(peaks[k].heat);
  }
  for (int& group : groups.group) {
    if (group >= 0) group = kept[static_cast<size_t>(group)];
  }
  return groups;
}

}  // namespace simwright::twin
