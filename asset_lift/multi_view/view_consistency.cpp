#include "asset_lift/multi_view/view_consistency.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "asset_lift/multi_view/visual_hull.h"
#include "core/error.h"
#include "core/parallel.h"

namespace simwright::asset_lift {
namespace {

constexpr int kViewConsistencySide = 64;  // of the images in which masks are compared
constexpr int kNoView = -1;

// A node that lies inside the masks of all views, or of all views but `against`.
struct Place {
  Eigen::Vector3d point;
  int against;
};

// Returns the nodes of a grid over `box` that at most one of the `used` views has outside its mask
// by more than half a cell.
std::vector<Place> ConsistentNodes(const std::vector<SilhouetteCone>& cones,
                                   const std::vector<int>& used, const Eigen::AlignedBox3d& box,
                                   int cells, double* cell) {
  *cell = box.sizes().maxCoeff() / cells;
  const int n = cells + 1;
  std::vector<std::vector<Place>> layers(n);
  core::ParallelFor(n, [&](int k) {
    core::CheckCancelled();
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const Eigen::Vector3d p = box.min() + *cell * Eigen::Vector3d(i, j, k);
        int outside = 0, against = kNoView;
        for (std::size_t u = 0; u < used.size() && outside < 2; ++u) {
          if (cones[used[u]].At(p) <= 0.5 * *cell) continue;
          ++outside;
          against = static_cast<int>(u);
        }
        if (outside < 2) layers[k].push_back({p, against});
      }
    }
  });
  std::vector<Place> places;
  for (const auto& layer : layers) places.insert(places.end(), layer.begin(), layer.end());
  return places;
}

// A scaled-down mask of a view, and its pixels that nodes explain.
class Explained {
 public:
  Explained(const ObservedView& view, double cell)
      : camera_(view.camera),
        camera_from_world_(view.camera.world_from_camera.inverse()),
        scale_(std::min(1.0, static_cast<double>(kViewConsistencySide) /
                                 std::max(view.camera.width, view.camera.height))),
        width_(std::max(1, static_cast<int>(std::ceil(view.camera.width * scale_)))),
        height_(std::max(1, static_cast<int>(std::ceil(view.camera.height * scale_)))),
        cell_(cell),
        mask_(static_cast<std::size_t>(width_) * height_, 0) {
    for (int y = 0; y < camera_.height; ++y) {
      for (int x = 0; x < camera_.width; ++x) {
        if (*view.opacity.At(x, y) >= 0.5f) {
          mask_[static_cast<std::size_t>(y * scale_) * width_ +
                static_cast<std::size_t>(x * scale_)] = 1;
        }
      }
    }
    mask_size_ = std::count(mask_.begin(), mask_.end(), 1);
  }

  std::vector<std::uint8_t> Nothing() const { return std::vector<std::uint8_t>(mask_.size(), 0); }

  // Marks the pixels covered by a cell around the node.
  void Mark(const Eigen::Vector3d& place, std::vector<std::uint8_t>* seen) const {
    const Eigen::Vector3d p = camera_from_world_ * place;
    if (!(p.z() > 0.0)) return;
    const double x = (camera_.fx * p.x() / p.z() + camera_.cx) * scale_;
    const double y = (camera_.fy * p.y() / p.z() + camera_.cy) * scale_;
    const double reach = 0.5 * cell_ * camera_.fx / p.z() * scale_ + 0.5;
    const int x0 = std::max(0, static_cast<int>(std::floor(x - reach)));
    const int y0 = std::max(0, static_cast<int>(std::floor(y - reach)));
    const int x1 = std::min(width_ - 1, static_cast<int>(std::floor(x + reach)));
    const int y1 = std::min(height_ - 1, static_cast<int>(std::floor(y + reach)));
    for (int j = y0; j <= y1; ++j) {
      for (int i = x0; i <= x1; ++i) (*seen)[static_cast<std::size_t>(j) * width_ + i] = 1;
    }
  }

  // Returns the share of the mask that neither `seen` nor `more` marks.
  double Unexplained(const std::vector<std::uint8_t>& seen,
                     const std::vector<std::uint8_t>& more) const {
    std::int64_t left = 0;
    for (std::size_t i = 0; i < mask_.size(); ++i) left += mask_[i] && !seen[i] && !more[i];
    return static_cast<double>(left) / static_cast<double>(mask_size_);
  }

 private:
  core::Camera camera_;
  Eigen::Isometry3d camera_from_world_;
  double scale_;
  int width_, height_;
  double cell_;
  std::vector<std::uint8_t> mask_;
  std::int64_t mask_size_;
};

// Returns unexplained[v][u]: the share of view u's mask not explained by the nodes that all views
// but v agree on (v = used: all).
std::vector<std::vector<double>> Unexplained(const std::vector<ObservedView>& views,
                                             const std::vector<int>& used,
                                             const std::vector<Place>& places, double cell) {
  const int n = static_cast<int>(used.size());
  std::vector<std::vector<double>> shares(n + 1, std::vector<double>(n, 0.0));
  core::ParallelFor(n, [&](int u) {
    core::CheckCancelled();
    const Explained view(views[used[u]], cell);
    std::vector<std::uint8_t> agreed = view.Nothing();
    std::vector<std::vector<std::uint8_t>> without(n, agreed);
    for (const Place& place : places) {
      view.Mark(place.point, place.against == kNoView ? &agreed : &without[place.against]);
    }
    for (int v = 0; v < n; ++v) shares[v][u] = view.Unexplained(agreed, without[v]);
    shares[n][u] = view.Unexplained(agreed, agreed);
  });
  return shares;
}

double Worst(const std::vector<double>& shares, int but) {
  double worst = 0.0;
  for (std::size_t u = 0; u < shares.size(); ++u) {
    if (static_cast<int>(u) != but) worst = std::max(worst, shares[u]);
  }
  return worst;
}

}  // namespace

ViewConsistency CheckViewConsistency(const std::vector<ObservedView>& views, double tolerance,
                                     int cells) {
  RequireValid(views);
  if (views.size() < 2) throw core::Error("a consistency check needs at least two views");
  std::vector<SilhouetteCone> cones;
  for (const ObservedView& view : views) cones.emplace_back(view);
  ViewConsistency agreement;
  std::vector<int> used(views.size());
  for (std::size_t i = 0; i < used.size(); ++i) used[i] = static_cast<int>(i);
  const auto blame = [&](int index, double share) {
    agreement.contradicting.push_back(index);
    char sentence[160];
    std::snprintf(sentence, sizeof sentence,
                  "the camera or mask of view %d contradicts the other views: %.0f%% of a mask "
                  "have no point that all views agree on",
                  index, 100.0 * share);
    agreement.findings.push_back({"view-contradicts", core::Severity::kWarning,
                                  "view " + std::to_string(index), sentence, share});
  };
  while (used.size() >= 2) {
    std::vector<ObservedView> of_used;
    for (const int i : used) of_used.push_back(views[i]);
    double cell = 0.0;
    const std::vector<Place> places =
        ConsistentNodes(cones, used, MaskBounds(of_used), cells, &cell);
    const auto shares = Unexplained(views, used, places, cell);
    const int n = static_cast<int>(used.size());
    if (agreement.unexplained.empty()) agreement.unexplained = shares[n];
    const double worst = Worst(shares[n], kNoView);
    if (worst <= tolerance) break;
    int best = 0;
    for (int v = 1; v < n; ++v) {
      if (Worst(shares[v], v) < Worst(shares[best], best)) best = v;
    }
    // With two views either may be the wrong one.
    if (n == 2) {
      for (const int i : used) blame(i, worst);
      break;
    }
    if (Worst(shares[best], best) > 0.9 * worst) {
      // If excluding any single view helps little, the view with the least in common is excluded
      // first.
      for (int v = 0; v < n; ++v) {
        if (shares[v][v] > shares[best][best]) best = v;
      }
    }
    blame(used[best], worst);
    used.erase(used.begin() + best);
  }
  std::sort(agreement.contradicting.begin(), agreement.contradicting.end());
  return agreement;
}

}  // namespace simwright::asset_lift
