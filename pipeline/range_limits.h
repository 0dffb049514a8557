#pragma once

#include "assets/urdf_reader.h"
#include "core/finding.h"

namespace simwright::pipeline {

struct RangeOptions {
  double most = 0.005;    // m, overlap that is trimmed away later and does not count here
  bool on_floor = false;  // the root stands on z = 0, and so the floor is in the way
  bool end_ranges = true;  // false: only pairs that overlap at zero are excluded (a robot's links)
  // Of a joint's range: where less would be left, the thing cannot stand on that floor.
  double least_left = 0.1;
};

struct RangeResult {
  core::Findings findings;
  bool floor_in_the_way = false;  // a joint would keep less than `least_left`: nothing was cut by it
};

// Ends the ranges of joints (other joints at zero) where what they carry would be deeper than `most`
// in the floor, or in a link that is no neighbour by a joint: a lid that a file lets swing through
// the table, a drawer through another one. Zero stays inside. A continuous joint that cannot turn
// all round becomes revolute. Pairs that overlap with all joints at zero already are excluded from
// contact first: no range helps them. A finding tells of each.
RangeResult EndRangesAtObstacles(const RangeOptions& options, assets::UrdfModel* model);

}  // namespace simwright::pipeline
