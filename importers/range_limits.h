#pragma once

#include "assets/urdf_reader.h"
#include "core/finding.h"

namespace simwright::importers {

struct RangeOptions {
  double most = 0.005;       // m, overlap that is ignored because it is trimmed later
  bool on_floor = false;     // the root stands on z = 0, so the floor is an obstacle
  bool limit_ranges = true;  // false: only excludes pairs that overlap at zero (robot links)
  // The smallest fraction of a joint's range that may remain. If less would remain, the asset
  // cannot stand on that floor.
  double least_left = 0.1;
};

struct RangeResult {
  core::Findings findings;
  bool floor_in_the_way = false;  // a joint would keep less than `least_left`; the floor cut none
};

// Limits the ranges of joints (other joints at zero) where the links they carry would penetrate the
// floor, or a link that is not a neighbour by a joint, by more than `most`: a lid whose file lets
// it swing through the table, a drawer through another one. Zero stays within the limits. A
// continuous joint that cannot rotate fully becomes revolute. Pairs that already overlap with all
// joints at zero are first excluded from contact, because no range separates them. Each change has
// a finding.
RangeResult LimitRangesAtObstacles(const RangeOptions& options, assets::UrdfModel* model);

}  // namespace simwright::importers
