#include "asset_lift/field_carving.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "asset_lift/occupancy_grid.h"
#include "core/parallel.h"
#include "core/progress.h"

namespace simwright::asset_lift {
namespace {

constexpr int kSide = OccupancyGrid::kSide;
constexpr int kCells = kSide * kSide * kSide;
constexpr double kAgreement = 0.8;

// Distance of each pixel to the nearest one of the mask, in pixels: along columns, then along rows.
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

// 1 where the view rules the cell out.
std::vector<std::uint8_t> RuledOut(const ObservedView& view, const Eigen::Vector3d& center,
                                   double half_side, double margin) {
  const std::vector<float> distance = DistanceToMask(view.opacity);
  const core::Camera& camera = view.camera;
  const Eigen::Isometry3d camera_from_world = camera.world_from_camera.inverse();
  const double cell = OccupancyGrid::kCell * half_side;
  const double radius = 0.5 * std::sqrt(3.0) * cell;
  std::vector<std::uint8_t> out(kCells, 0);
  core::ParallelFor(kSide, [&](int k) {
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
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
        // A pixel's centre is up to 0.71 from where the cell projects to.
        if (distance[static_cast<std::size_t>(py) * camera.width + px] > reach + 0.75) {
          out[i + kSide * (j + kSide * k)] = 1;
        }
      }
    }
  });
  return out;
}

class Jury {
 public:
  Jury(const std::vector<ObservedView>& views, const Eigen::Vector3d& center, double half_side,
       double margin)
      : views_(views), center_(center), half_side_(half_side), votes_(kCells, 0) {
    for (const ObservedView& view : views) {
      core::CheckCancelled();
      out_.push_back(RuledOut(view, center, half_side, margin));
      for (int c = 0; c < kCells; ++c) votes_[c] += out_.back()[c];
    }
    heard_.assign(views.size(), true);
  }

  void Dismiss(int view) {
    heard_[view] = false;
    for (int c = 0; c < kCells; ++c) votes_[c] -= out_[view][c];
  }

  // What the views that are heard leave, but for `absent` (-1: none).
  std::vector<std::uint8_t> Allowed(int absent) const {
    std::vector<std::uint8_t> allowed(kCells);
    for (int c = 0; c < kCells; ++c) {
      allowed[c] = votes_[c] - (absent >= 0 ? out_[absent][c] : 0) == 0;
    }
    return allowed;
  }

  // The least share of a heard mask's pixels (of every third row and column) that see something.
  double LeastAgreement(int absent, int* worst) const {
    OccupancyGrid grid;
    grid.Restrict(Allowed(absent));
    double least = 1.0;
    for (int v = 0; v < static_cast<int>(views_.size()); ++v) {
      if (!heard_[v] || v == absent) continue;
      const double share = Agreement(grid, views_[v]);
      if (share < least) {
        least = share;
        if (worst != nullptr) *worst = v;
      }
    }
    return least;
  }

  int heard() const { return static_cast<int>(std::count(heard_.begin(), heard_.end(), true)); }
  bool Hears(int view) const { return heard_[view]; }

 private:
  double Agreement(const OccupancyGrid& grid, const ObservedView& view) const {
    int seen = 0, met = 0;
    for (int y = 1; y < view.camera.height; y += 3) {
      for (int x = 1; x < view.camera.width; x += 3) {
        if (*view.opacity.At(x, y) <= 0.5f) continue;
        ++seen;
        double near = 0.0, far = 1e30;
        met += grid.Clip((view.camera.position() - center_) / half_side_,
                         view.camera.Ray({x + 0.5, y + 0.5}) / half_side_, &near, &far);
      }
    }
    return seen > 0 ? static_cast<double>(met) / seen : 1.0;
  }

  const std::vector<ObservedView>& views_;
  const Eigen::Vector3d center_;
  const double half_side_;
  std::vector<std::vector<std::uint8_t>> out_;  // per view
  std::vector<int> votes_;                      // heard views that rule a cell out
  std::vector<bool> heard_;
};

core::Finding Contradiction(const std::string& place, double agreement) {
  return {"field-view-contradiction", core::Severity::kWarning, place,
          "the camera of " + place + " contradicts the other views' masks", agreement};
}

}  // namespace

Carving CarveByMasks(const std::vector<ObservedView>& views, const Eigen::Vector3d& center,
                     double half_side, double margin) {
  Carving carving;
  Jury jury(views, center, half_side, margin);
  int worst = 0;
  double agreement = jury.LeastAgreement(-1, &worst);
  while (agreement < kAgreement) {
    if (jury.heard() <= 2) {
      // Nothing says which of the two is wrong; or the only view sees nothing of the cube.
      std::string place;
      for (int v = 0; v < static_cast<int>(views.size()); ++v) {
        if (!jury.Hears(v)) continue;
        place += (place.empty() ? "view " : " and view ") + std::to_string(v + 1);
      }
      carving.findings.push_back(Contradiction(place, agreement));
      if (jury.heard() == 1) {
        carving.findings.back().sentence =
            "much of the mask of " + place + " lies outside of the cube that is looked at";
      }
      carving.allowed.assign(kCells, 1);
      return carving;
    }
    int culprit = worst;
    double best = agreement;
    for (int v = 0; v < static_cast<int>(views.size()); ++v) {
      if (!jury.Hears(v)) continue;
      const double without = jury.LeastAgreement(v, nullptr);
      if (without > best) {
        best = without;
        culprit = v;
      }
    }
    jury.Dismiss(culprit);
    carving.contradicting.push_back(culprit);
    carving.findings.push_back(Contradiction("view " + std::to_string(culprit + 1), agreement));
    agreement = jury.LeastAgreement(-1, &worst);
  }
  carving.allowed = jury.Allowed(-1);
  return carving;
}

}  // namespace simwright::asset_lift
