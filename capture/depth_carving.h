#pragma once

#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "geometry/isosurface.h"

namespace simwright::capture {

struct DepthCarvingOptions {
  double band_cells = 3.0;  // cells before and behind a measured depth that it describes
  int least_views = 2;      // that must measure a cell's surroundings
  // The correction of the hull is carried into cells that no depth describes, where it fades over
  // about 1 / sqrt(fading) cells.
  double fading = 0.03;
  int relaxations = 80;
};

// Takes from a hull what lies before the depths of the views (their `depth`; views without are
// ignored): hollows and flat tops, which outlines do not show. `hull`: its signed distance (world,
// m), as HullField returns it. The mean of the truncated signed distances to the measured depths
// (Curless and Levoy 1996, "A volumetric method for building complex models from range images")
// replaces the hull's own where at least `least_views` views measure it, and the difference fades
// smoothly elsewhere. Nothing is added to the hull. Throws core::Cancelled.
void CarveByDepth(const std::vector<asset_lift::ObservedView>& views,
                  const DepthCarvingOptions& options, geometry::ScalarGrid* hull);

}  // namespace simwright::capture
