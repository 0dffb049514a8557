#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/observed_view.h"
#include "core/finding.h"

namespace simwright::asset_lift {

// What the masks of views leave of a cube of 64^3 cells.
struct Carving {
  // (64^3, x fastest) 1 where no mask rules the cell out; all 1 where fewer than two of several
  // views agree, or where the masks leave less than 80% of one of them anything to see.
  std::vector<std::uint8_t> allowed;
  // Views left out (view_agreement.h), ascending; none where fewer than two would be left.
  std::vector<int> contradicting;
  core::Findings findings;  // "view-contradicts"; "field-beside-object"
};

// A cell is ruled out by a view if it lies in front of the camera and projects into the picture
// with nothing of the mask (opacity above 0.02) within its radius and `margin` pixels. Beyond the
// picture's border the object may go on where its mask reaches the border.
Carving CarveByMasks(const std::vector<ObservedView>& views, const Eigen::Vector3d& center,
                     double half_side, double margin);

}  // namespace simwright::asset_lift
