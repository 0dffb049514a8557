#pragma once

#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "core/progress.h"
#include "geometry/isosurface.h"

namespace simwright::asset_lift {

// Carves `field` (inside is below 0, m) by colour consistency: surface nodes whose colours in the
// views that see them deviate by more than `tolerance` (standard deviation, sRGB, all channels
// together) become outside, layer by layer, until none does (Kutulakos and Seitz, "A theory of
// shape by space carving", 2000). At least two views must see a node, and pixels at silhouettes,
// where colours mix, do not count. Small leftover components are removed too. Returns false and
// leaves `field` unchanged where the colours agree nowhere, so that carving would erode the masked
// object: more than 3% of a mask would have no occupied cell behind it.
bool CarveByColor(const std::vector<ObservedView>& views, double tolerance,
                  geometry::ScalarGrid* field, core::Progress* progress);

}  // namespace simwright::asset_lift
