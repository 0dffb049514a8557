#include "geometry/quickhull.h"

#include <limits>

namespace simwright::geometry {

using core::kLanes;
using core::Lanes;

SIMWRIGHT_WIDEST_VECTORS void Quickhull::Distribute(const std::vector<int>& candidates,
                                                    const std::vector<int>& faces) {
  // Four faces at once: rows of normals and offsets. No point is above a missing face.
  const int count = static_cast<int>(faces.size());
  const int groups = (count + kLanes - 1) / kLanes;
  packed_.assign(static_cast<std::size_t>(4 * kLanes * groups), 0.0);
  for (int i = 0; i < kLanes * groups; ++i) {
    double* at = packed_.data() + 4 * kLanes * (i / kLanes) + i % kLanes;
    for (int k = 0; k < 3 && i < count; ++k) at[k * kLanes] = faces_[faces[i]].normal[k];
    at[3 * kLanes] = i < count ? faces_[faces[i]].offset : std::numeric_limits<double>::infinity();
  }
  const Lanes* rows = reinterpret_cast<const Lanes*>(packed_.data());
  const Lanes zero = {};
  for (const int p : candidates) {
    const Vector3d& point = points_[p];
    Lanes highest = zero + tolerance_, group = zero - 1.0;
    for (int g = 0; g < groups; ++g) {
      const Lanes* row = rows + 4 * g;
      const Lanes height = row[0] * point.x() + row[1] * point.y() + row[2] * point.z() - row[3];
      const auto above = height > highest;
      highest = above ? height : highest;
      group = above ? zero + static_cast<double>(g) : group;
    }
    int best = -1;
    double top = tolerance_;
    for (int k = 0; k < kLanes; ++k) {
      const int place = kLanes * static_cast<int>(group[k]) + k;
      if (highest[k] > top || (highest[k] == top && best >= 0 && place < best)) {
        top = highest[k];
        best = place;
      }
    }
    if (best >= 0) Assign(p, faces[best], top);
  }
  for (const int f : faces) {
    if (faces_[f].first >= 0) pending_.push_back(f);
  }
}

}  // namespace simwright::geometry
