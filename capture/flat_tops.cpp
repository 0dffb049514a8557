#include "capture/flat_tops.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "asset_lift/multi_view/visual_hull.h"
#include "core/parallel.h"

namespace simwright::capture {
namespace {

// A place where the line of sight through a pixel at an outline runs inside the hull.
struct OutlineSample {
  int sight = 0;        // index of the line of sight
  float height = 0.0f;  // m above the grid's origin
};

// The lines of sight of one view through the pixels just inside its outline.
struct OutlineSights {
  std::vector<std::vector<std::pair<int, float>>> inside;  // per sight: column and height
};

constexpr double kOnSurface = 0.25;  // cells beside the hull that still count as inside

// Returns the field between its nodes, from `at` in cells; far outside beside the grid.
double FieldAt(const geometry::ScalarGrid& field, const Eigen::Vector3d& at) {
  const int i = static_cast<int>(std::floor(at.x())), j = static_cast<int>(std::floor(at.y()));
  const int k = static_cast<int>(std::floor(at.z()));
  if (i < 0 || j < 0 || k < 0 || i + 1 >= field.nx || j + 1 >= field.ny || k + 1 >= field.nz) {
    return 1e9;
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = i + (corner & 1), y = j + (corner >> 1 & 1), z = k + (corner >> 2);
    const double weight =
        (1.0 - std::abs(at.x() - x)) * (1.0 - std::abs(at.y() - y)) * (1.0 - std::abs(at.z() - z));
    sum += weight * field.values[field.Index(x, y, z)];
  }
  return sum;
}

OutlineSights SightsOf(const asset_lift::ObservedView& view, const geometry::ScalarGrid& hull) {
  OutlineSights sights;
  const core::FloatImage distance = asset_lift::MaskDistance(view.opacity);
  const Eigen::Vector3d sides = hull.cell * Eigen::Vector3d(hull.nx - 1, hull.ny - 1, hull.nz - 1);
  const Eigen::AlignedBox3d box(hull.origin, hull.origin + sides);
  for (int y = 0; y < distance.height; ++y) {
    for (int x = 0; x < distance.width; ++x) {
      const float d = *distance.At(x, y);
      if (d > 0.0f || d <= -1.0f) continue;
      const Eigen::Vector3d ray = view.camera.Ray(Eigen::Vector2d(x + 0.5, y + 0.5)).normalized();
      const double middle = (box.center() - view.camera.position()).dot(ray);
      const double reach = 0.5 * sides.norm();
      std::vector<std::pair<int, float>> inside;
      for (double t = middle - reach; t < middle + reach; t += 0.5 * hull.cell) {
        const Eigen::Vector3d at = (view.camera.position() + t * ray - hull.origin) / hull.cell;
        if (FieldAt(hull, at) > kOnSurface * hull.cell) continue;
        const int i = static_cast<int>(std::lround(at.x()));
        const int j = static_cast<int>(std::lround(at.y()));
        inside.emplace_back(i + hull.nx * j, static_cast<float>(at.z() * hull.cell));
      }
      if (!inside.empty()) sights.inside.push_back(std::move(inside));
    }
  }
  return sights;
}

class PeakLowering {
 public:
  PeakLowering(const std::vector<asset_lift::ObservedView>& views, const FlatTopOptions& options,
               geometry::ScalarGrid* hull)
      : options_(options), hull_(*hull), columns_(hull->nx * hull->ny) {
    MeasureRoof();
    TraceSights(views);
    label_.assign(static_cast<std::size_t>(columns_), -1);
  }

  void Run() {
    std::vector<int> order(static_cast<std::size_t>(columns_));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) { return roof_[a] > roof_[b]; });
    const float step = static_cast<float>(options_.level_step * hull_.cell);
    std::size_t next = 0;
    for (float level = roof_[order[0]] - step; level > step; level -= step) {
      for (; next < order.size() && roof_[order[next]] > level; ++next) Enter(order[next]);
      for (std::size_t p = 0; p < peaks_.size(); ++p) {
        if (peaks_[p].open && !peaks_[p].columns.empty()) Lower(&peaks_[p], level);
      }
    }
    Cut();
  }

 private:
  // A part of the roof above a level; closed where its outline stopped it.
  struct Peak {
    std::vector<int> columns;
    bool open = true;
    std::vector<int> uncovered;  // per view
  };

  void MeasureRoof();
  void TraceSights(const std::vector<asset_lift::ObservedView>& views);
  void Enter(int column);
  void Lower(Peak* peak, float level);
  void Cut();

  const FlatTopOptions& options_;
  geometry::ScalarGrid& hull_;
  int columns_;
  std::vector<float> roof_, cap_;  // per column, m above the grid's origin; 0: empty
  std::vector<std::vector<OutlineSample>> samples_;  // per column, highest first
  std::vector<std::size_t> removed_;                 // per column, of its samples
  std::vector<int> covered_;                         // per sight: samples that are left
  std::vector<int> view_of_;                         // per sight
  std::vector<int> limit_;                           // per view
  std::vector<int> label_;                           // per column: the peak, or -1
  std::vector<Peak> peaks_;
};

// Sets the height at which each column leaves the hull.
void PeakLowering::MeasureRoof() {
  roof_.assign(static_cast<std::size_t>(columns_), 0.0f);
  const float cell = static_cast<float>(hull_.cell);
  for (int c = 0; c < columns_; ++c) {
    const int i = c % hull_.nx, j = c / hull_.nx;
    for (int k = hull_.nz - 2; k >= 0; --k) {
      const float here = hull_.values[hull_.Index(i, j, k)];
      if (here >= 0.0f) continue;
      const float above = hull_.values[hull_.Index(i, j, k + 1)];
      roof_[c] = cell * (static_cast<float>(k) + here / (here - above));
      break;
    }
  }
  cap_ = roof_;
}

void PeakLowering::TraceSights(const std::vector<asset_lift::ObservedView>& views) {
  std::vector<OutlineSights> traced(views.size());
  core::ParallelFor(static_cast<int>(views.size()), [&](int v) {
    traced[static_cast<std::size_t>(v)] = SightsOf(views[static_cast<std::size_t>(v)], hull_);
  });
  samples_.resize(static_cast<std::size_t>(columns_));
  for (std::size_t v = 0; v < traced.size(); ++v) {
    for (const auto& inside : traced[v].inside) {
      const int sight = static_cast<int>(covered_.size());
      for (const auto& [column, height] : inside) samples_[column].push_back({sight, height});
      covered_.push_back(static_cast<int>(inside.size()));
      view_of_.push_back(static_cast<int>(v));
    }
    const auto share = options_.uncovered_share * static_cast<double>(traced[v].inside.size());
    limit_.push_back(options_.uncovered_pixels + static_cast<int>(share));
  }
  for (std::vector<OutlineSample>& column : samples_) {
    std::sort(column.begin(), column.end(),
              [](const OutlineSample& a, const OutlineSample& b) { return a.height > b.height; });
  }
  removed_.assign(samples_.size(), 0);
}

// Adds a column to the peak that it touches; it joins open peaks, and what touches a closed one
// stays as it is.
void PeakLowering::Enter(int column) {
  const int x = column % hull_.nx, y = column / hull_.nx;
  std::vector<int> touching;
  bool closed = false;
  for (int j = std::max(0, y - 1); j <= std::min(hull_.ny - 1, y + 1); ++j) {
    for (int i = std::max(0, x - 1); i <= std::min(hull_.nx - 1, x + 1); ++i) {
      const int label = label_[i + hull_.nx * j];
      if (label < 0) continue;
      closed |= !peaks_[label].open;
      if (std::find(touching.begin(), touching.end(), label) == touching.end()) {
        touching.push_back(label);
      }
    }
  }
  if (touching.empty()) {
    touching.push_back(static_cast<int>(peaks_.size()));
    peaks_.push_back({{}, true, std::vector<int>(limit_.size(), 0)});
  }
  Peak& into = peaks_[touching[0]];
  for (std::size_t k = 1; k < touching.size(); ++k) {
    Peak& from = peaks_[touching[k]];
    for (const int c : from.columns) label_[c] = touching[0];
    into.columns.insert(into.columns.end(), from.columns.begin(), from.columns.end());
    for (std::size_t v = 0; v < limit_.size(); ++v) into.uncovered[v] += from.uncovered[v];
    from.columns.clear();
  }
  if (closed) into.open = false;
  into.columns.push_back(column);
  label_[column] = touching[0];
}

// Lowers an open peak to a level, or closes it where that uncovers outlines.
void PeakLowering::Lower(Peak* peak, float level) {
  std::vector<int> uncovered = peak->uncovered;
  std::vector<std::size_t> before;
  before.reserve(peak->columns.size());
  for (const int c : peak->columns) {
    before.push_back(removed_[c]);
    const std::vector<OutlineSample>& column = samples_[c];
    for (std::size_t& k = removed_[c]; k < column.size() && column[k].height > level; ++k) {
      if (--covered_[column[k].sight] == 0) ++uncovered[view_of_[column[k].sight]];
    }
  }
  int over = 0;
  for (std::size_t v = 0; v < limit_.size(); ++v) over += uncovered[v] > limit_[v];
  if (over <= options_.tolerated_views) {
    peak->uncovered = std::move(uncovered);
    for (const int c : peak->columns) cap_[c] = level;
    return;
  }
  for (std::size_t i = 0; i < peak->columns.size(); ++i) {
    const int c = peak->columns[i];
    for (std::size_t& k = removed_[c]; k > before[i]; --k) ++covered_[samples_[c][k - 1].sight];
  }
  peak->open = false;
}

void PeakLowering::Cut() {
  for (int c = 0; c < columns_; ++c) {
    if (cap_[c] >= roof_[c]) continue;
    for (int k = 0; k < hull_.nz; ++k) {
      float& value = hull_.values[hull_.Index(c % hull_.nx, c / hull_.nx, k)];
      value = std::max(value, static_cast<float>(k * hull_.cell) - cap_[c]);
    }
  }
}

}  // namespace

void LowerPeaks(const std::vector<asset_lift::ObservedView>& views, const FlatTopOptions& options,
                geometry::ScalarGrid* hull) {
  PeakLowering(views, options, hull).Run();
}

}  // namespace simwright::capture
