#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/camera/observed_view.h"
#include "core/finding.h"

namespace simwright::asset_lift {

// The part of a cube of 64^3 cells that the masks of the views allow.
struct Carving {
  // (64^3, x fastest) 1 where no mask excludes the cell. All 1 where fewer than two of several
  // views agree, or where the masks leave less than 80% of one of them with an allowed cell behind
  // it.
  std::vector<std::uint8_t> allowed;
  // The excluded views (view_agreement.h), ascending; none where fewer than two would remain.
  std::vector<int> contradicting;
  core::Findings findings;  // "view-contradicts"; "field-beside-object"
};

// Carves a cube of 64^3 cells by the masks of the views. A view excludes a cell that lies in front
// of the camera and projects into the image with no mask pixel (opacity above 0.02) within its
// radius plus `margin` pixels. Beyond the image border the object may continue where its mask
// reaches the border.
Carving CarveByMasks(const std::vector<ObservedView>& views, const Eigen::Vector3d& center,
                     double half_side, double margin);

}  // namespace simwright::asset_lift
