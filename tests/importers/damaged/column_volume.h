#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::damaged {

// Vertical lines through a mesh, and where they are inside: an independent measure of what closed
// surfaces that may overlap enclose together. A point is inside where the surfaces wind around it
// at least once.
class ColumnVolume {
 public:
  // `columns`: lines along the longer horizontal side.
  ColumnVolume(const core::TriangleMesh& mesh, int columns);

  // Returns the enclosed volume, m^3.
  double Volume() const;

  // Returns true if the point at `z` (m) on the line (x, y) is inside.
  bool Inside(int x, int y, double z) const;

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  double cell() const { return cell_; }                   // m, between lines
  const Eigen::Vector2d& origin() const { return low_; }  // m, the corner of the first cell

 private:
  const std::vector<std::pair<double, double>>& Spans(int x, int y) const {
    return spans_[static_cast<std::size_t>(y) * nx_ + x];
  }

  Eigen::Vector2d low_{0, 0};
  double cell_ = 1.0;
  int nx_ = 0, ny_ = 0;
  std::vector<std::vector<std::pair<double, double>>> spans_;  // (ny x nx), from z to z, m
};

}  // namespace simwright::damaged
