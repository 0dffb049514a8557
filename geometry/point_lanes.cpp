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

struct FourPoints {
  Lanes x, y, z;
};

__attribute__((always_inline)) inline FourPoints PointsAt(const Rows& rows, int i) {
  FourPoints points;
  core::LoadLanes(rows[0].data() + i, &points.x);
  core::LoadLanes(rows[1].data() + i, &points.y);
  core::LoadLanes(rows[2].data() + i, &points.z);
  return points;
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
    const FourPoints p = PointsAt(rows, i);
    const Lanes height = normal.x() * p.x + normal.y() * p.y + normal.z() * p.z;
    highest = height > highest ? height : highest;
  }
  return std::max({highest[0], highest[1], highest[2], highest[3]});
}

SIMWRIGHT_WIDEST_VECTORS void KeepWithin(const Rows& rows, int size, const Eigen::AlignedBox3d& box,
                                         Rows* inside) {
  const Vector3d low = box.min(), high = box.max();
  for (std::vector<double>& row : *inside) row.reserve(static_cast<std::size_t>(size + kLanes));
  for (int i = 0; i < size; i += kLanes) {
    const FourPoints p = PointsAt(rows, i);
    const auto mask = (p.x >= low[0]) & (p.x <= high[0]) & (p.y >= low[1]) & (p.y <= high[1]) &
                      (p.z >= low[2]) & (p.z <= high[2]);
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
    const FourPoints p = PointsAt(rows, i);
    Lanes depth = {};
    depth += kNoBound;
    for (const Vector4d& plane : planes) {
      const Lanes below = plane[3] - (plane[0] * p.x + plane[1] * p.y + plane[2] * p.z);
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
    const FourPoints p = PointsAt(rows, i);
    auto below = p.x == p.x;
    for (const Vector4d& plane : planes) {
      below &= plane[0] * p.x + plane[1] * p.y + plane[2] * p.z < plane[3];
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
