#include "geometry/quickhull.h"

#include <limits>

#include "core/lanes.h"

namespace simwright::geometry {
namespace {

using core::kLanes;
using core::Lanes;
using Eigen::Vector3d;

// Returns the face that `p` is farthest above, the first of equals, and sets its height; -1 if it
// is above none by more than `tolerance`. `packed`: for each four faces, rows of the three
// coordinates of their normals and of their offsets.
SIMWRIGHT_WIDEST_VECTORS int HighestAbove(const double* packed, int groups, const Vector3d& p,
                                          double tolerance, double* height) {
  const Lanes zero = {};
  Lanes highest = zero + tolerance, group = zero - 1.0;
  for (int g = 0; g < groups; ++g) {
    Lanes row[4];
    for (int k = 0; k < 4; ++k) core::LoadLanes(packed + (4 * g + k) * kLanes, &row[k]);
    const Lanes here = row[0] * p.x() + row[1] * p.y() + row[2] * p.z() - row[3];
    const auto above = here > highest;
    highest = above ? here : highest;
    group = above ? zero + static_cast<double>(g) : group;
  }
  int best = -1;
  *height = tolerance;
  for (int k = 0; k < kLanes; ++k) {
    const int place = kLanes * static_cast<int>(group[k]) + k;
    if (highest[k] > *height || (highest[k] == *height && best >= 0 && place < best)) {
      *height = highest[k];
      best = place;
    }
  }
  return best;
}

}  // namespace

void Quickhull::Distribute(const std::vector<int>& candidates, const std::vector<int>& faces) {
  // No point is above a missing face.
  const int count = static_cast<int>(faces.size());
  const int groups = (count + kLanes - 1) / kLanes;
  packed_.assign(static_cast<std::size_t>(4 * kLanes * groups), 0.0);
  for (int i = 0; i < kLanes * groups; ++i) {
    double* at = packed_.data() + 4 * kLanes * (i / kLanes) + i % kLanes;
    for (int k = 0; k < 3 && i < count; ++k) at[k * kLanes] = faces_[faces[i]].normal[k];
    at[3 * kLanes] = i < count ? faces_[faces[i]].offset : std::numeric_limits<double>::infinity();
  }
  for (const int p : candidates) {
    double height;
    const int best = HighestAbove(packed_.data(), groups, points_[p], tolerance_, &height);
    if (best >= 0) Assign(p, faces[best], height);
  }
  for (const int f : faces) {
    if (faces_[f].first >= 0) pending_.push_back(f);
  }
}

}  // namespace simwright::geometry
