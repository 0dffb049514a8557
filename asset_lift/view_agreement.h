#pragma once

#include <vector>

#include "asset_lift/observed_view.h"
#include "core/finding.h"

namespace simwright::asset_lift {

struct ViewAgreement {
  // For each view the share of its mask that no place within all masks explains, [0, 1].
  std::vector<double> unexplained;
  // Views that contradict the others, by index, ascending: without
  // them the rest agree (or agree best). More than one for one contradiction where the others
  // cannot say which is wrong, as with two views.
  std::vector<int> contradicting;
  // One a contradicting view, code "view-contradicts", place "view I", the share as figure.
  core::Findings findings;
};

// Whether the views' masks can be of one object: each part of each mask has to be explained by
// places that lie in all the others' cones. A wrong camera leaves parts of its own mask, and of the
// others', without any. Found by leaving views out, one at a time. `tolerance`: the share of a mask
// that may stay unexplained (outlines a pixel off, coarse grids). `cells` along the longest side.
// Throws core::Error for views that are not valid or fewer than two; core::Cancelled.
ViewAgreement ExamineViews(const std::vector<ObservedView>& views, double tolerance = 0.06,
                           int cells = 64);

}  // namespace simwright::asset_lift
