#pragma once

#include <vector>

#include "asset_lift/observed_view.h"
#include "core/progress.h"
#include "geometry/isosurface.h"

namespace simwright::asset_lift {

// Takes away what the views see in different colours: nodes at the surface of `field` (inside is
// below 0, m) whose colours in the views that see them deviate by more than `tolerance` (standard
// deviation, sRGB, all channels together) become outside, layer by layer, until none does
// (Kutulakos and Seitz, "A theory of shape by space carving", 2000). Two views at least must see a
// node, and pixels at outlines, where colours mix, do not count. Crumbs left by chance go with
// them. Returns false, `field` as it was, where the colours agree nowhere, so that carving would
// eat what the masks show: more than 3% of a mask would have nothing behind it.
bool CarveByColor(const std::vector<ObservedView>& views, double tolerance,
                  geometry::ScalarGrid* field, core::Progress* progress);

}  // namespace simwright::asset_lift
