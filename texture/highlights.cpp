#include "texture/highlights.h"

#include <algorithm>
#include <cmath>

#include "render/light.h"

namespace simwright::texture {
namespace {

// Brightness relative to the median albedo about a pixel: of a highlight's core, and of its rim.
constexpr float kCore = 1.35f, kRim = 1.12f;
constexpr float kLessSaturated = 0.88f;  // of the median's saturation, unless that is grey
constexpr float kGreySaturation = 0.12f;
constexpr double kLargestShare = 0.12;  // of the object, of one highlight
constexpr float kSharpest = 1.25f;      // step of brightness at the border: print has sharp borders
constexpr double kFlank = 0.25;  // least share of a highlight's pixels below half of its height
constexpr float kNormalSpread = 0.86f;  // mean cosine of a highlight's normals to their mean

float SaturationOf(const Eigen::Vector3f& color) {
  const float high = color.maxCoeff();
  return high > 1e-4f ? 1.0f - color.minCoeff() / high : 0.0f;
}

// Returns the median albedo about each pixel, channel by channel, on a coarse grid of cells whose
// window is some quarter of the object wide.
class MedianAlbedo {
 public:
  MedianAlbedo(const ObjectPixels& pixels, const std::vector<Eigen::Vector3f>& albedo)
      : pixels_(pixels) {
    const double side = std::sqrt(static_cast<double>(std::max(1, pixels.count())));
    cell_ = std::max(2, static_cast<int>(side / 16.0));
    columns_ = (pixels.width + cell_ - 1) / cell_;
    rows_ = (pixels.height + cell_ - 1) / cell_;
    std::vector<std::vector<int>> members(static_cast<std::size_t>(columns_ * rows_));
    const int stride = std::max(1, cell_ / 6);
    for (int i = 0; i < pixels.count(); ++i) {
      const int x = pixels.at[static_cast<std::size_t>(i)] % pixels.width;
      const int y = pixels.at[static_cast<std::size_t>(i)] / pixels.width;
      if (x % stride != 0 || y % stride != 0) continue;
      members[static_cast<std::size_t>(Cell(x, y))].push_back(i);
    }
    medians_.resize(members.size(), Eigen::Vector3f::Zero());
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) Fill(row, column, members, albedo);
    }
  }

  const Eigen::Vector3f& At(int pixel) const {
    const int at = pixels_.at[static_cast<std::size_t>(pixel)];
    return medians_[static_cast<std::size_t>(Cell(at % pixels_.width, at / pixels_.width))];
  }

 private:
  int Cell(int x, int y) const { return y / cell_ * columns_ + x / cell_; }

  void Fill(int row, int column, const std::vector<std::vector<int>>& members,
            const std::vector<Eigen::Vector3f>& albedo) {
    constexpr int kReach = 2;  // cells
    std::vector<float> values[3];
    for (int y = std::max(0, row - kReach); y <= std::min(rows_ - 1, row + kReach); ++y) {
      for (int x = std::max(0, column - kReach); x <= std::min(columns_ - 1, column + kReach);
           ++x) {
        for (const int i : members[static_cast<std::size_t>(y * columns_ + x)]) {
          for (int c = 0; c < 3; ++c) {
            values[c].push_back(albedo[static_cast<std::size_t>(i)][c]);
          }
        }
      }
    }
    if (values[0].empty()) return;
    Eigen::Vector3f& median = medians_[static_cast<std::size_t>(row * columns_ + column)];
    for (int c = 0; c < 3; ++c) {
      const auto middle = values[c].begin() + static_cast<long>(values[c].size() / 2);
      std::nth_element(values[c].begin(), middle, values[c].end());
      median[c] = *middle;
    }
  }

  const ObjectPixels& pixels_;
  int cell_ = 2, columns_ = 0, rows_ = 0;
  std::vector<Eigen::Vector3f> medians_;
};

// Returns the connected regions (4 neighbours) of marked pixels that have a pixel of level 2.
std::vector<std::vector<int>> Regions(const ObjectPixels& pixels, const std::vector<char>& level) {
  std::vector<std::vector<int>> regions;
  std::vector<char> done(level.size(), 0);
  for (int start = 0; start < pixels.count(); ++start) {
    if (level[static_cast<std::size_t>(start)] < 2 || done[static_cast<std::size_t>(start)]) {
      continue;
    }
    std::vector<int>& region = regions.emplace_back(1, start);
    done[static_cast<std::size_t>(start)] = 1;
    for (std::size_t next = 0; next < region.size(); ++next) {
      const int at = pixels.at[static_cast<std::size_t>(region[next])];
      const int x = at % pixels.width, y = at / pixels.width;
      constexpr int kDx[] = {1, -1, 0, 0}, kDy[] = {0, 0, 1, -1};
      for (int k = 0; k < 4; ++k) {
        const int nx = x + kDx[k], ny = y + kDy[k];
        if (nx < 0 || ny < 0 || nx >= pixels.width || ny >= pixels.height) continue;
        const int other = pixels.index[static_cast<std::size_t>(ny * pixels.width + nx)];
        if (other < 0 || level[static_cast<std::size_t>(other)] < 1) continue;
        if (done[static_cast<std::size_t>(other)]) continue;
        done[static_cast<std::size_t>(other)] = 1;
        region.push_back(other);
      }
    }
  }
  return regions;
}

// Returns the mean ratio of the albedo's brightness inside to outside, of neighbours across a
// region's border; 1 without a border inside the object.
float BorderStep(const ObjectPixels& pixels, const std::vector<int>& region,
                 const std::vector<char>& level, const std::vector<Eigen::Vector3f>& albedo) {
  double sum = 0.0;
  int count = 0;
  for (const int i : region) {
    const int at = pixels.at[static_cast<std::size_t>(i)];
    const int x = at % pixels.width, y = at / pixels.width;
    constexpr int kDx[] = {1, -1, 0, 0}, kDy[] = {0, 0, 1, -1};
    for (int k = 0; k < 4; ++k) {
      const int nx = x + kDx[k], ny = y + kDy[k];
      if (nx < 0 || ny < 0 || nx >= pixels.width || ny >= pixels.height) continue;
      const int other = pixels.index[static_cast<std::size_t>(ny * pixels.width + nx)];
      if (other < 0 || level[static_cast<std::size_t>(other)] > 0) continue;
      sum += Brightness(albedo[static_cast<std::size_t>(i)]) /
             Brightness(albedo[static_cast<std::size_t>(other)]);
      ++count;
    }
  }
  return count > 0 ? static_cast<float>(sum / count) : 1.0f;
}

// Returns the share of a region's pixels that stand out by less than half of the region's height
// (95th percentile) above the usual albedo. Print has few of them, also where its border is
// blurred.
double FlankShare(const std::vector<int>& region, const MedianAlbedo& median,
                  const std::vector<Eigen::Vector3f>& albedo) {
  std::vector<float> excess;
  for (const int i : region) {
    excess.push_back(Brightness(albedo[static_cast<std::size_t>(i)]) / Brightness(median.At(i)) -
                     1.0f);
  }
  std::sort(excess.begin(), excess.end());
  const float height = excess[(excess.size() - 1) * 95 / 100];
  const auto half = std::lower_bound(excess.begin(), excess.end(), 0.5f * height);
  return static_cast<double>(half - excess.begin()) / static_cast<double>(excess.size());
}

// Returns true if a region lies where the surface mirrors the brighter side of the light.
bool ReflectsTheLight(const ObjectPixels& pixels, const std::vector<int>& region,
                      const Eigen::Matrix<float, 9, 1>& light, const Eigen::Vector3f& viewer) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const int i : region) sum += pixels.normal[static_cast<std::size_t>(i)];
  const float length = sum.norm() / static_cast<float>(region.size());
  if (length < kNormalSpread) return false;  // print that runs around the object
  const Eigen::Vector3f normal = sum.normalized();
  const Eigen::Vector3f mirrored = 2.0f * normal.dot(viewer) * normal - viewer;
  const float mean = light[0] * render::IrradianceWeights(mirrored)[0];
  return light.dot(render::IrradianceWeights(mirrored)) > mean;
}

}  // namespace

std::vector<char> ReplaceHighlights(const ObjectPixels& pixels,
                                    const Eigen::Matrix<float, 9, 1>& light,
                                    const Eigen::Vector3f& viewer,
                                    std::vector<Eigen::Vector3f>* albedo) {
  const MedianAlbedo median(pixels, *albedo);
  std::vector<char> level(albedo->size(), 0);
  for (int i = 0; i < pixels.count(); ++i) {
    const Eigen::Vector3f& a = (*albedo)[static_cast<std::size_t>(i)];
    const Eigen::Vector3f& usual = median.At(i);
    const float saturation = SaturationOf(usual);
    const bool pale = saturation < kGreySaturation || SaturationOf(a) < kLessSaturated * saturation;
    const float ratio = Brightness(a) / Brightness(usual);
    if (pale) level[static_cast<std::size_t>(i)] = ratio > kCore ? 2 : (ratio > kRim ? 1 : 0);
  }
  std::vector<char> replaced(albedo->size(), 0);
  for (const std::vector<int>& region : Regions(pixels, level)) {
    if (static_cast<double>(region.size()) > kLargestShare * pixels.count()) continue;
    if (BorderStep(pixels, region, level, *albedo) > kSharpest) continue;
    if (FlankShare(region, median, *albedo) < kFlank) continue;
    if (!ReflectsTheLight(pixels, region, light, viewer)) continue;
    for (const int i : region) {
      replaced[static_cast<std::size_t>(i)] = 1;
      (*albedo)[static_cast<std::size_t>(i)] = median.At(i);
    }
  }
  return replaced;
}

}  // namespace simwright::texture
