#include "twin/detected_pixels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace simwright::twin {
namespace {

constexpr float kInside = 0.5f;      // probability from which a pixel shows an object
constexpr float kLeastHeat = 0.25f;  // of a peak
constexpr int kPeakReach = 3;        // pixels: a peak is the largest within
constexpr float kFarthest = 60.0f;   // pixels from where an offset points to its centre
constexpr int kLeastGroup = 12;      // pixels
constexpr int kTouchReach = 2;       // pixels between groups that touch
// Groups that touch are one object if the distance of the means of where their offsets point is
// less than this share of the distance of the means of their pixels. Of two objects each points to
// its own middle, so that the share is about 1, even if the offsets are too short; of the parts of
// one object all point to the same middle, and the share is about 0.
constexpr double kOneObject = 0.7;

struct Peak {
  Eigen::Vector2f at;
  float heat = 0.0f;
};

// Returns the values smoothed by the binomial kernel 1 2 1 in both directions.
std::vector<float> Smoothed(const std::vector<float>& values, int width, int height) {
  const auto pass = [&](const std::vector<float>& from, int dx, int dy) {
    std::vector<float> to(from.size());
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto at = [&](int side) {
          const int nx = std::clamp(x + side * dx, 0, width - 1);
          const int ny = std::clamp(y + side * dy, 0, height - 1);
          return from[static_cast<size_t>(ny) * width + nx];
        };
        to[static_cast<size_t>(y) * width + x] = 0.25f * at(-1) + 0.5f * at(0) + 0.25f * at(1);
      }
    }
    return to;
  };
  return pass(pass(values, 1, 0), 0, 1);
}

std::vector<Peak> FindPeaks(const std::vector<float>& heats, int width, int height) {
  std::vector<Peak> peaks;
  const auto heat = [&](int x, int y) { return heats[static_cast<size_t>(y) * width + x]; };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float value = heat(x, y);
      if (value < kLeastHeat) continue;
      bool largest = true;
      for (int dy = -kPeakReach; dy <= kPeakReach && largest; ++dy) {
        for (int dx = -kPeakReach; dx <= kPeakReach && largest; ++dx) {
          const int nx = x + dx, ny = y + dy;
          if ((dx == 0 && dy == 0) || nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
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

// Sums over the pixels of a group.
struct GroupSums {
  Eigen::Vector2d at{0, 0}, to{0, 0};  // of the pixels, and of where their offsets point
  int count = 0;
  float heat = 0.0f;

  void Add(const GroupSums& other) {
    at += other.at;
    to += other.to;
    count += other.count;
    heat = std::max(heat, other.heat);
  }
};

// Joins the groups that are parts of one object.
class GroupJoining {
 public:
  GroupJoining(const DetectedPixels& pixels, const std::vector<Peak>& peaks,
               std::vector<int>* group)
      : pixels_(pixels), group_(*group), sums_(peaks.size()), touches_(peaks.size()) {
    for (size_t k = 0; k < peaks.size(); ++k) sums_[k].heat = peaks[k].heat;
    for (int y = 0; y < pixels.height; ++y) {
      for (int x = 0; x < pixels.width; ++x) {
        const int of = GroupAt(x, y);
        if (of < 0) continue;
        GroupSums& sums = sums_[static_cast<size_t>(of)];
        const Eigen::Vector2d at(x, y);
        sums.at += at;
        sums.to += at + pixels.offset[static_cast<size_t>(y) * pixels.width + x].cast<double>();
        ++sums.count;
        for (int step = 1; step <= kTouchReach; ++step) {
          Touch(of, x + step, y);
          Touch(of, x, y + step);
        }
      }
    }
  }

  // Joins the pairs with the least share first; renumbers the groups.
  void Run() {
    std::vector<int> joined(sums_.size());
    for (size_t k = 0; k < joined.size(); ++k) joined[k] = static_cast<int>(k);
    while (true) {
      double least = kOneObject;
      int into = -1, from = -1;
      for (size_t a = 0; a < touches_.size(); ++a) {
        for (const auto& [b, is_touching] : touches_[a]) {
          const double share = Share(sums_[a], sums_[static_cast<size_t>(b)]);
          if (share >= least) continue;
          least = share;
          into = static_cast<int>(a);
          from = b;
        }
      }
      if (into < 0) break;
      Join(into, from);
      for (int& of : joined) of = of == from ? into : of;
    }
    for (int& of : group_) of = of < 0 ? -1 : joined[static_cast<size_t>(of)];
  }

  const std::vector<GroupSums>& sums() const { return sums_; }

 private:
  int GroupAt(int x, int y) const { return group_[static_cast<size_t>(y) * pixels_.width + x]; }

  void Touch(int of, int x, int y) {
    if (x >= pixels_.width || y >= pixels_.height) return;
    const int other = GroupAt(x, y);
    if (other < 0 || other == of) return;
    touches_[static_cast<size_t>(std::min(of, other))][std::max(of, other)] = true;
  }

  static double Share(const GroupSums& a, const GroupSums& b) {
    const double apart = (a.at / a.count - b.at / b.count).norm();
    return (a.to / a.count - b.to / b.count).norm() / std::max(1e-9, apart);
  }

  void Join(int into, int from) {
    const auto a = static_cast<size_t>(into), b = static_cast<size_t>(from);
    sums_[a].Add(sums_[b]);
    sums_[b] = {};
    std::map<int, bool> neighbours = std::move(touches_[b]);
    touches_[b].clear();
    touches_[a].erase(from);
    for (size_t k = 0; k < touches_.size(); ++k) {
      if (k != a && touches_[k].erase(from) > 0) neighbours[static_cast<int>(k)] = true;
    }
    for (const auto& [other, is_touching] : neighbours) {
      if (other == into) continue;
      touches_[static_cast<size_t>(std::min(into, other))][std::max(into, other)] = true;
    }
  }

  const DetectedPixels& pixels_;
  std::vector<int>& group_;
  std::vector<GroupSums> sums_;
  std::vector<std::map<int, bool>> touches_;  // by group: the later groups that it touches
};

}  // namespace

PixelGroups GroupPixels(const DetectedPixels& pixels) {
  const std::vector<Peak> peaks =
      FindPeaks(Smoothed(pixels.centre, pixels.width, pixels.height), pixels.width, pixels.height);
  PixelGroups groups;
  groups.group.assign(pixels.object.size(), -1);
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
    }
  }
  GroupJoining joining(pixels, peaks, &groups.group);
  joining.Run();
  std::vector<int> kept(peaks.size(), -1);
  for (size_t k = 0; k < peaks.size(); ++k) {
    const GroupSums& sums = joining.sums()[k];
    if (sums.count < kLeastGroup) continue;
    kept[k] = static_cast<int>(groups.centre.size());
    groups.centre.push_back(sums.heat);
  }
  for (int& group : groups.group) {
    if (group >= 0) group = kept[static_cast<size_t>(group)];
  }
  return groups;
}

}  // namespace simwright::twin
