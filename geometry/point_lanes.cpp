#include "geometry/point_lanes.h"

#include <algorithm>
#include <limits>

#include "core/lanes.h"

namespace simwright::geometry {
namespace {

using core::kLanes;
using core::Lanes;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Rows = std::array<std::vector<double>, 3>;

constexpr double kNoBound = std::numeric_limits<double>::infinity();

__attribute__((always_inline)) inline const Lanes& RowAt(const std::vector<double>& row, int i) {
  return *reinterpret_cast<const Lanes*>(row.data() + i);
}

// Returns true if any lane of a comparison is.
template <typename Mask>
__attribute__((always_inline)) inline bool Any(const Mask& mask) {
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

SIMWRIGHT_WIDEST_VECTORS double SupportOf(const Rows& rows, int size, const Vector3d& normal) {
  Lanes highest = {};
  highest -= kNoBound;
  for (int i = 0; i < size; i += kLanes) {
    const Lanes height = normal.x() * RowAt(rows[0], i) + normal.y() * RowAt(rows[1], i) +
                         normal.z() * RowAt(rows[2], i);
    highest = height > highest ? height : highest;
  }
  return std::max({highest[0], highest[1], highest[2], highest[3]});
}

SIMWRIGHT_WIDEST_VECTORS void KeepWithin(const Rows& rows, int size, const Eigen::AlignedBox3d& box,
                                         Rows* inside) {
  const Vector3d low = box.min(), high = box.max();
  for (std::vector<double>& row : *inside) row.reserve(static_cast<std::size_t>(size + kLanes));
  for (int i = 0; i < size; i += kLanes) {
    auto mask = RowAt(rows[0], i) >= low[0];
    mask &= RowAt(rows[0], i) <= high[0];
    for (int k = 1; k < 3; ++k) {
      mask &= RowAt(rows[k], i) >= low[k];
      mask &= RowAt(rows[k], i) <= high[k];
    }
    if (!Any(mask)) continue;
    for (int j = i; j < std::min(i + kLanes, size); ++j) {
      if (mask[j - i] == 0) continue;
      for (int k = 0; k < 3; ++k) (*inside)[k].push_back(rows[k][j]);
    }
  }
}

SIMWRIGHT_WIDEST_VECTORS double DepthOf(const Rows& rows, int size,
                                        const std::vector<Vector4d>& planes, double enough) {
  double deepest = 0.0;
  for (int i = 0; i < size; i += kLanes) {
    const Lanes x = RowAt(rows[0], i), y = RowAt(rows[1], i), z = RowAt(rows[2], i);
    Lanes depth = {};
    depth += kNoBound;
    for (const Vector4d& plane : planes) {
      const Lanes below = plane[3] - (plane[0] * x + plane[1] * y + plane[2] * z);
      depth = below < depth ? below : depth;
      if (!Any(depth > deepest)) break;
    }
    for (int k = 0; k < kLanes; ++k) {
      deepest = std::max(deepest, depth[k]);
      if (deepest > enough) return deepest;
    }
  }
  return deepest;
}

SIMWRIGHT_WIDEST_VECTORS int PointsBelow(const Rows& rows, int size,
                                         const std::vector<Vector4d>& planes) {
  int count = 0;
  for (int i = 0; i < size; i += kLanes) {
    const Lanes x = RowAt(rows[0], i), y = RowAt(rows[1], i), z = RowAt(rows[2], i);
    auto below = x == x;
    for (const Vector4d& plane : planes) {
      below &= plane[0] * x + plane[1] * y + plane[2] * z < plane[3];
      if (!Any(below)) break;
    }
    for (int k = 0; k < std::min(kLanes, size - i); ++k) count += below[k] != 0;
  }
  return count;
}

}  // namespace

PointLanes::PointLanes(const std::vector<Vector3d>& points)
    : size_(static_cast<int>(points.size())) {
  for (int k = 0; k < 3; ++k) {
    rows_[k].reserve(points.size() + kLanes);
    for (const Vector3d& p : points) rows_[k].push_back(p[k]);
  }
  FillUp();
}

void PointLanes::FillUp() {
  for (std::vector<double>& row : rows_) {
    while (row.size() % kLanes != 0) row.push_back(row.back());
  }
}

double PointLanes::Support(const Vector3d& normal) const {
  return SupportOf(rows_, size_, normal);
}

PointLanes PointLanes::Within(const Eigen::AlignedBox3d& box) const {
  PointLanes inside;
  KeepWithin(rows_, size_, box, &inside.rows_);
  inside.size_ = static_cast<int>(inside.rows_[0].size());
  inside.FillUp();
  return inside;
}

double PointLanes::Depth(const std::vector<Vector4d>& planes, double enough) const {
  return DepthOf(rows_, size_, planes, enough);
}

int PointLanes::CountBelow(const std::vector<Vector4d>& planes) const {
  return PointsBelow(rows_, size_, planes);
}

}  // namespace simwright::geometry
