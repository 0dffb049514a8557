#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/observed_view.h"
#include "core/finding.h"

namespace simwright::asset_lift {

// What the masks of views leave of a cube of 64^3 cells.
struct Carving {
  // (64^3, x fastest) 1 where no mask rules the cell out; all 1 where the views do not agree and
  // nothing says which of them is wrong.
  std::vector<std::uint8_t> allowed;
  std::vector<int> contradicting;  // views that the others contradict, left out of the carving
  core::Findings findings;         // "field-view-contradiction": which, and how much of its mask
};

// A cell is ruled out by a view if it lies in front of the camera and projects into the picture
// with nothing of the mask (opacity above 0.02) within its radius and `margin` pixels. Beyond the
// picture's border the object may go on where its mask reaches the border.
// Views agree where each one's mask (opacity above 0.5) is met by rays through what the others
// leave, for 80% of its pixels at least; else the views whose absence mends most are left out, one
// at a time.
Carving CarveByMasks(const std::vector<ObservedView>& views, const Eigen::Vector3d& center,
                     double half_side, double margin);

}  // namespace simwright::asset_lift
