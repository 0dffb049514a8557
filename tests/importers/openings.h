#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <vector>

#include "core/mesh.h"
#include "geometry/triangle_tree.h"

namespace simwright {

// The deepest point of a shape that holds water, seen from above (m, in the shape's frame).
struct Hollow {
  Eigen::Vector2d place{0, 0};
  double floor = 0.0;  // height of the bottom there
  double brim = 0.0;   // height to which water stands
  double depth() const { return brim - floor; }
};

// Returns the first hits of a grid of rays along -z, `cell` apart; -infinity for misses.
class HeightMap {
 public:
  HeightMap(const core::TriangleMesh& mesh, double cell) : cell_(cell) {
    const geometry::TriangleTree tree(mesh);
    const Eigen::AlignedBox3d box = core::Bounds(mesh);
    origin_ = box.min().head<2>() - Eigen::Vector2d::Constant(1.5 * cell);
    width_ = static_cast<int>(box.sizes().x() / cell) + 4;
    height_ = static_cast<int>(box.sizes().y() / cell) + 4;
    const double top = box.max().z() + 1.0;
    for (int j = 0; j < height_; ++j) {
      for (int i = 0; i < width_; ++i) {
        const Eigen::Vector2d at = At(i, j);
        const auto hit = tree.FirstHit({at.x(), at.y(), top}, -Eigen::Vector3d::UnitZ());
        values_.push_back(hit ? hit->point.z() : -std::numeric_limits<double>::infinity());
      }
    }
  }

  // Water poured on the shape until it overflows: a flood from the border inward, lowest cell first
  // (Barnes et al. 2014, "Priority-flood").
  std::vector<double> WaterLevel() const {
    std::vector<double> level(values_.size(), std::numeric_limits<double>::infinity());
    using Item = std::pair<double, int>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
    for (int j = 0; j < height_; ++j) {
      for (int i = 0; i < width_; ++i) {
        if (i > 0 && j > 0 && i + 1 < width_ && j + 1 < height_) continue;
        level[j * width_ + i] = values_[j * width_ + i];
        open.emplace(level[j * width_ + i], j * width_ + i);
      }
    }
    while (!open.empty()) {
      const auto [height, at] = open.top();
      open.pop();
      const int i = at % width_, j = at / width_;
      for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        if (i + di < 0 || j + dj < 0 || i + di >= width_ || j + dj >= height_) continue;
        const int other = (j + dj) * width_ + i + di;
        if (std::isfinite(level[other]) || level[other] < 0) continue;
        level[other] = std::max(height, values_[other]);
        open.emplace(level[other], other);
      }
    }
    return level;
  }

  // The centre of the deepest tenth of the largest body of water.
  Hollow DeepestHollow() const {
    const std::vector<double> level = WaterLevel();
    double deepest = 0.0;
    for (std::size_t c = 0; c < level.size(); ++c) {
      if (std::isfinite(values_[c])) deepest = std::max(deepest, level[c] - values_[c]);
    }
    Hollow hollow;
    int count = 0;
    for (int c = 0; c < static_cast<int>(level.size()); ++c) {
      if (!std::isfinite(values_[c]) || level[c] - values_[c] < 0.9 * deepest) continue;
      hollow.place += At(c % width_, c / width_);
      hollow.floor += values_[c];
      hollow.brim += level[c];
      ++count;
    }
    if (count == 0) return hollow;
    hollow.place /= count;
    hollow.floor /= count;
    hollow.brim /= count;
    return hollow;
  }

 private:
  Eigen::Vector2d At(int i, int j) const {
    return origin_ + cell_ * Eigen::Vector2d(i + 0.5, j + 0.5);
  }
  double cell_;
  Eigen::Vector2d origin_;
  int width_ = 0, height_ = 0;
  std::vector<double> values_;
};

// A level line through a hole of a shape's silhouette: over all directions, the one whose centre is
// farthest from the silhouette.
struct ThroughHole {
  Eigen::Vector3d middle{0, 0, 0};
  Eigen::Vector3d direction{1, 0, 0};
  double clearance = 0.0;  // m, from the centre to the silhouette
};

inline ThroughHole WidestHole(const core::TriangleMesh& mesh, int cells = 96) {
  const geometry::TriangleTree tree(mesh);
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  const double radius = 0.55 * box.diagonal().norm();
  const double cell = 2.0 * radius / cells;
  ThroughHole best;
  for (int turn = 0; turn < 36; ++turn) {
    const double yaw = turn * std::numbers::pi / 36.0;
    const Eigen::Vector3d direction(std::cos(yaw), std::sin(yaw), 0.0);
    const Eigen::Vector3d side(-std::sin(yaw), std::cos(yaw), 0.0);
    const auto point = [&](int c) -> Eigen::Vector3d {
      return box.center() + ((c % cells + 0.5) * cell - radius) * side +
             ((c / cells + 0.5) * cell - radius) * Eigen::Vector3d::UnitZ();
    };
    // 0: inside the shape's silhouette, 1: free, 2: free and reached from the border.
    std::vector<char> state(cells * cells);
    for (int c = 0; c < cells * cells; ++c) {
      state[c] = !tree.FirstHit(point(c) - 2.0 * radius * direction, direction);
    }
    std::vector<int> queue{0};
    state[0] = 2;
    for (std::size_t at = 0; at < queue.size(); ++at) {
      const int i = queue[at] % cells, j = queue[at] / cells;
      for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        if (i + di < 0 || j + dj < 0 || i + di >= cells || j + dj >= cells) continue;
        const int other = (j + dj) * cells + i + di;
        if (state[other] != 1) continue;
        state[other] = 2;
        queue.push_back(other);
      }
    }
    for (int c = 0; c < cells * cells; ++c) {
      if (state[c] != 1) continue;
      double clearance = std::numeric_limits<double>::infinity();
      for (int o = 0; o < cells * cells; ++o) {
        if (state[o] == 0) clearance = std::min(clearance, (point(o) - point(c)).norm());
      }
      if (clearance > best.clearance) best = {point(c), direction, clearance};
    }
  }
  return best;
}

}  // namespace simwright
