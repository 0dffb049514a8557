#include "tests/importers/damaged/column_volume.h"

#include <algorithm>
#include <cmath>

namespace simwright::damaged {
namespace {

// Lines through the middles of cells would meet the edges of symmetric meshes.
constexpr double kOffMiddleX = 0.5137, kOffMiddleY = 0.4871;

using Crossing = std::pair<double, int>;  // z, +1 where a line enters going up, else -1

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::vector<std::pair<double, double>> InsideSpans(std::vector<Crossing>* crossings) {
  std::sort(crossings->begin(), crossings->end());
  std::vector<std::pair<double, double>> spans;
  int winding = 0;
  for (const auto& [z, turn] : *crossings) {
    if (winding <= 0 && winding + turn > 0) spans.emplace_back(z, z);
    if (winding > 0 && winding + turn <= 0) spans.back().second = z;
    winding += turn;
  }
  return spans;
}

}  // namespace

ColumnVolume::ColumnVolume(const core::TriangleMesh& mesh, int columns) {
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  low_ = box.min().head<2>();
  const Eigen::Vector2d sides = box.sizes().head<2>();
  cell_ = sides.maxCoeff() / columns;
  nx_ = std::max(1, static_cast<int>(std::ceil(sides.x() / cell_)));
  ny_ = std::max(1, static_cast<int>(std::ceil(sides.y() / cell_)));
  std::vector<std::vector<Crossing>> crossings(static_cast<std::size_t>(nx_) * ny_);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    Eigen::AlignedBox2d flat;
    Eigen::Vector2d p[3];
    for (int k = 0; k < 3; ++k) flat.extend(p[k] = mesh.vertices[t[k]].head<2>());
    const double area = Cross(p[1] - p[0], p[2] - p[0]);
    if (area == 0.0) continue;
    const auto index = [&](double at, double low, int count) {
      return std::clamp(static_cast<int>(std::floor((at - low) / cell_)), 0, count - 1);
    };
    const int x1 = index(flat.max().x(), low_.x(), nx_), y1 = index(flat.max().y(), low_.y(), ny_);
    for (int y = index(flat.min().y(), low_.y(), ny_); y <= y1; ++y) {
      for (int x = index(flat.min().x(), low_.x(), nx_); x <= x1; ++x) {
        const Eigen::Vector2d at = low_ + cell_ * Eigen::Vector2d(x + kOffMiddleX, y + kOffMiddleY);
        const double w0 = Cross(p[2] - p[1], at - p[1]) / area;
        const double w1 = Cross(p[0] - p[2], at - p[2]) / area;
        const double w2 = 1.0 - w0 - w1;
        if (w0 < 0.0 || w1 < 0.0 || w2 < 0.0) continue;
        const double z = w0 * mesh.vertices[t[0]].z() + w1 * mesh.vertices[t[1]].z() +
                         w2 * mesh.vertices[t[2]].z();
        crossings[static_cast<std::size_t>(y) * nx_ + x].emplace_back(z, area < 0.0 ? 1 : -1);
      }
    }
  }
  for (std::vector<Crossing>& line : crossings) spans_.push_back(InsideSpans(&line));
}

double ColumnVolume::Volume() const {
  double length = 0.0;
  for (const auto& line : spans_) {
    for (const auto& [from, to] : line) length += to - from;
  }
  return length * cell_ * cell_;
}

bool ColumnVolume::Inside(int x, int y, double z) const {
  if (x < 0 || y < 0 || x >= nx_ || y >= ny_) return false;
  for (const auto& [from, to] : Spans(x, y)) {
    if (z > from && z < to) return true;
  }
  return false;
}

}  // namespace simwright::damaged
