#include "capture/depth_carving.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/parallel.h"
#include "core/progress.h"

namespace simwright::capture {
namespace {

constexpr double kViewWeight = 2.0;  // of a view's depth against the smoothness of the correction
constexpr int kMostWeights = 8;      // views that count

// The camera and depths of a view, for lookups.
class DepthView {
 public:
  explicit DepthView(const asset_lift::ObservedView& view)
      : view_(&view), camera_from_world_(view.camera.world_from_camera.inverse()) {}

  // Returns how far a point lies before the measured depth, m; not a number without a depth.
  double Before(const Eigen::Vector3d& point) const {
    const core::Camera& camera = view_->camera;
    const Eigen::Vector3d p = camera_from_world_ * point;
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (!(p.z() > 0.0)) return kNone;
    const int x = static_cast<int>(std::floor(camera.fx * p.x() / p.z() + camera.cx));
    const int y = static_cast<int>(std::floor(camera.fy * p.y() / p.z() + camera.cy));
    if (x < 0 || y < 0 || x >= camera.width || y >= camera.height) return kNone;
    const float depth = *view_->depth.At(x, y);
    return depth > 0.0f ? depth - p.z() : kNone;
  }

 private:
  const asset_lift::ObservedView* view_;
  Eigen::Isometry3d camera_from_world_;
};

class DepthCarving {
 public:
  DepthCarving(const std::vector<asset_lift::ObservedView>& views,
               const DepthCarvingOptions& options, geometry::ScalarGrid* hull)
      : options_(options), band_(options.band_cells * hull->cell), field_(*hull) {
    for (const asset_lift::ObservedView& view : views) {
      if (!view.depth.empty()) views_.emplace_back(view);
    }
  }

  void Run() {
    if (!Measure()) return;
    Relax();
    for (std::size_t i = 0; i < field_.values.size(); ++i) {
      field_.values[i] += std::max(0.0f, correction_[i]);
    }
  }

 private:
  bool Measure();
  void Relax();
  Eigen::Vector3d Node(int i, int j, int k) const {
    return field_.origin + field_.cell * Eigen::Vector3d(i, j, k);
  }

  const DepthCarvingOptions& options_;
  std::vector<DepthView> views_;
  double band_;                    // m
  geometry::ScalarGrid& field_;    // of the hull
  std::vector<float> weights_;     // per node, of the measured correction; 0: not measured
  std::vector<float> measured_;    // corrections, m
  std::vector<float> correction_;  // relaxed ones
};

// Returns false if no node is measured.
bool DepthCarving::Measure() {
  weights_.assign(field_.values.size(), 0.0f);
  measured_.assign(field_.values.size(), 0.0f);
  std::vector<std::uint8_t> any(static_cast<std::size_t>(field_.nz), 0);
  core::ParallelFor(field_.nz, [&](int k) {
    core::CheckCancelled();
    for (int j = 0; j < field_.ny; ++j) {
      for (int i = 0; i < field_.nx; ++i) {
        const std::size_t n = field_.Index(i, j, k);
        if (field_.values[n] >= static_cast<float>(band_)) continue;
        const Eigen::Vector3d point = Node(i, j, k);
        double sum = 0.0;
        int count = 0;
        for (const DepthView& view : views_) {
          const double before = view.Before(point);
          if (!(before > -band_)) continue;
          sum += std::min(before, band_);
          ++count;
        }
        if (count < options_.least_views) continue;
        weights_[n] = static_cast<float>(kViewWeight * std::min(count, kMostWeights));
        measured_[n] = static_cast<float>(sum / count) -
                       std::max(field_.values[n], static_cast<float>(-band_));
        any[static_cast<std::size_t>(k)] = 1;
      }
    }
  });
  return std::find(any.begin(), any.end(), 1) != any.end();
}

// Solves the screened Poisson equation of the correction by red-black Gauss-Seidel steps.
void DepthCarving::Relax() {
  correction_ = measured_;
  const std::size_t row = static_cast<std::size_t>(field_.nx), slab = row * field_.ny;
  const auto fading = static_cast<float>(options_.fading);
  for (int step = 0; step < 2 * options_.relaxations; ++step) {
    core::ParallelFor(field_.nz - 2, [&](int slice) {
      const int k = slice + 1;
      for (int j = 1; j + 1 < field_.ny; ++j) {
        for (int i = 1 + (j + k + step) % 2; i + 1 < field_.nx; i += 2) {
          const std::size_t n = field_.Index(i, j, k);
          const float around = correction_[n - 1] + correction_[n + 1] + correction_[n - row] +
                               correction_[n + row] + correction_[n - slab] + correction_[n + slab];
          correction_[n] = (weights_[n] * measured_[n] + around) / (weights_[n] + fading + 6.0f);
        }
      }
    });
  }
}

}  // namespace

void CarveByDepth(const std::vector<asset_lift::ObservedView>& views,
                  const DepthCarvingOptions& options, geometry::ScalarGrid* hull) {
  DepthCarving(views, options, hull).Run();
}

}  // namespace simwright::capture
