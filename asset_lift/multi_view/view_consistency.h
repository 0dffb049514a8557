#pragma once

#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "core/finding.h"

namespace simwright::asset_lift {

struct ViewConsistency {
  // Per view, the share of its mask that no point inside all masks explains, [0, 1].
  std::vector<double> unexplained;
  // The views that contradict the others, by index, ascending: without them the rest agree (or
  // agree best). There are more than one for one contradiction where the others cannot decide which
  // is wrong, as with two views.
  std::vector<int> contradicting;
  // One finding per contradicting view, code "view-contradicts", place "view I", with the share as
  // its figure.
  core::Findings findings;
};

// Checks whether the views' masks are consistent with one object: each part of each mask must be
// explained by points inside the cones of all other masks. A wrong camera leaves parts of its own
// mask, and of the others', unexplained. Contradicting views are found by leaving out one view at a
// time. `tolerance` is the share of a mask that may stay unexplained (silhouettes a pixel off,
// coarse grids). `cells` are along the longest side. Throws core::Error for invalid views or fewer
// than two; core::Cancelled.
ViewConsistency CheckViewConsistency(const std::vector<ObservedView>& views,
                                     double tolerance = 0.06, int cells = 64);

}  // namespace simwright::asset_lift
