#pragma once

#include "asset_lift/shape_prior.h"

namespace simwright::asset_lift {

// Makes a prediction agree with its crop's outline: nothing far beside it, something behind each of
// its pixels. Where the network is sure of a pixel's column, its word stands. Elsewhere it knows
// about where, but not where exactly: there a sheet goes through the columns, as smooth as the
// network's spread leaves free, and about as thick as the outline is wide, since what is thin in
// the picture is mostly thin along the sight line.
// From `crop` and `logits`; fills `front_w` and `back_w`.
void HoldToOutline(ShapePrediction* prediction);

}  // namespace simwright::asset_lift
