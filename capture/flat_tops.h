#pragma once

#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "geometry/isosurface.h"

namespace simwright::capture {

struct FlatTopOptions {
  double level_step = 0.5;  // cells by which a peak is lowered at a time
  // Pixels of a view's outline that a lowered peak may uncover, and the share of the outline.
  int uncovered_pixels = 4;
  double uncovered_share = 0.005;
  int tolerated_views = 1;  // views that may uncover more
};

// Lowers each peak of a visual hull to a horizontal plane, as far as the views' outlines stay
// covered. Photos of a flat top that all look down leave a roof of cones on it: the rim alone
// touches the outlines, and the lowest plane that covers them is the top. Where a top is round, the
// outlines stop the plane at once. `hull`: as VotingHullField returns it, m.
void LowerPeaks(const std::vector<asset_lift::ObservedView>& views, const FlatTopOptions& options,
                geometry::ScalarGrid* hull);

}  // namespace simwright::capture
