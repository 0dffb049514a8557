#include "asset_lift/radiance_field/field_carving.h"

#include <algorithm>
#include <cmath>

#include "asset_lift/multi_view/view_consistency.h"
#include "asset_lift/radiance_field/occupancy_grid.h"
#include "core/parallel.h"
#include "core/progress.h"

namespace simwright::asset_lift {
namespace {

constexpr int kCarvingSide = OccupancyGrid::kSide;
constexpr int kCells = kCarvingSide * kCarvingSide * kCarvingSide;
constexpr double kMinMaskCoverage = 0.8;

// Returns each pixel's distance to the nearest mask pixel, in pixels: along columns, then along
// rows.
std::vector<float> DistanceToMask(const core::FloatImage& opacity) {
  const int width = opacity.width, height = opacity.height;
  constexpr float kFar = 1e6f;
  std::vector<float> column(static_cast<std::size_t>(width) * height), distance(column.size());
  for (int x = 0; x < width; ++x) {
    float last = kFar;
    for (int y = 0; y < height; ++y) {
      last = *opacity.At(x, y) > 0.02f ? 0.0f : last + 1.0f;
      column[static_cast<std::size_t>(y) * width + x] = last;
    }
    for (int y = height - 1; y >= 0; --y) {
      float& here = column[static_cast<std::size_t>(y) * width + x];
      last = here == 0.0f ? 0.0f : last + 1.0f;
      here = std::min(here, last);
    }
  }
  core::ParallelFor(height, [&](int y) {
    const float* row = &column[static_cast<std::size_t>(y) * width];
    for (int x = 0; x < width; ++x) {
      float best = row[x];
      for (int dx = 1; static_cast<float>(dx) < best; ++dx) {
        for (const int other : {x - dx, x + dx}) {
          if (other < 0 || other >= width) continue;
          best = std::min(best, std::hypot(static_cast<float>(dx), row[other]));
        }
        if (x - dx < 0 && x + dx >= width) break;
      }
      distance[static_cast<std::size_t>(y) * width + x] = best;
    }
  });
  return distance;
}

// Returns 1 for the cells that the view excludes.
std::vector<std::uint8_t> ExcludedCells(const ObservedView& view, const Eigen::Vector3d& center,
                                        double half_side, double margin) {
  const std::vector<float> distance = DistanceToMask(view.opacity);
  const core::Camera& camera = view.camera;
  const Eigen::Isometry3d camera_from_world = camera.world_from_camera.inverse();
  const double cell = OccupancyGrid::kCell * half_side;
  const double radius = 0.5 * std::sqrt(3.0) * cell;
  std::vector<std::uint8_t> out(kCells, 0);
  core::ParallelFor(kCarvingSide, [&](int k) {
    for (int j = 0; j < kCarvingSide; ++j) {
      for (int i = 0; i < kCarvingSide; ++i) {
        const Eigen::Vector3d unit =
            (Eigen::Vector3d(i, j, k).array() + 0.5) * OccupancyGrid::kCell - 1.0;
        const Eigen::Vector3d p = camera_from_world * (center + half_side * unit);
        if (p.z() <= radius) continue;
        const double x = camera.fx * p.x() / p.z() + camera.cx;
        const double y = camera.fy * p.y() / p.z() + camera.cy;
        const double reach = margin + radius * std::max(camera.fx, camera.fy) / (p.z() - radius);
        const int px =
            std::clamp(static_cast<int>(std::floor(std::clamp(x, -1e6, 1e6))), 0, camera.width - 1);
        const int py = std::clamp(static_cast<int>(std::floor(std::clamp(y, -1e6, 1e6))), 0,
                                  camera.height - 1);
        // A pixel's centre is up to 0.71 from the cell's projection.
        if (distance[static_cast<std::size_t>(py) * camera.width + px] > reach + 0.75) {
          out[i + kCarvingSide * (j + kCarvingSide * k)] = 1;
        }
      }
    }
  });
  return out;
}

// Returns the minimum over the views of the share of a view's mask (every third row and column)
// whose rays meet an allowed cell.
double MinMaskCoverage(const std::vector<ObservedView>& views,
                       const std::vector<std::uint8_t>& allowed, const Eigen::Vector3d& center,
                       double half_side) {
  OccupancyGrid grid;
  grid.Restrict(allowed);
  double least = 1.0;
  for (const ObservedView& view : views) {
    int seen = 0, met = 0;
    for (int y = 1; y < view.camera.height; y += 3) {
      for (int x = 1; x < view.camera.width; x += 3) {
        if (*view.opacity.At(x, y) <= 0.5f) continue;
        ++seen;
        double near = 0.0, far = 1e30;
        met += grid.Clip((view.camera.position() - center) / half_side,
                         view.camera.Ray({x + 0.5, y + 0.5}) / half_side, &near, &far);
      }
    }
    if (seen > 0) least = std::min(least, static_cast<double>(met) / seen);
  }
  return least;
}

}  // namespace

Carving CarveByMasks(const std::vector<ObservedView>& views, const Eigen::Vector3d& center,
                     double half_side, double margin) {
  Carving carving;
  carving.allowed.assign(kCells, 1);
  std::vector<ObservedView> agreeing = views;
  if (views.size() > 1) {
    const ViewConsistency agreement = CheckViewConsistency(views);
    carving.findings = agreement.findings;
    if (agreement.contradicting.size() + 2 > views.size()) return carving;
    carving.contradicting = agreement.contradicting;
    for (auto i = carving.contradicting.rbegin(); i != carving.contradicting.rend(); ++i) {
      agreeing.erase(agreeing.begin() + *i);
    }
  }
  for (const ObservedView& view : agreeing) {
    core::CheckCancelled();
    const std::vector<std::uint8_t> out = ExcludedCells(view, center, half_side, margin);
    for (int c = 0; c < kCells; ++c) carving.allowed[c] &= out[c] == 0;
  }
  if (const double seen = MinMaskCoverage(agreeing, carving.allowed, center, half_side);
      seen < kMinMaskCoverage) {
    carving.allowed.assign(kCells, 1);
    carving.findings.push_back({"field-beside-object", core::Severity::kWarning, "",
                                "much of a mask lies outside the field's cube", seen});
  }
  return carving;
}

}  // namespace simwright::asset_lift
