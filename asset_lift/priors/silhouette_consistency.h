#pragma once

#include "asset_lift/priors/shape_prior.h"

namespace simwright::asset_lift {

// Makes a prediction consistent with its crop's silhouette: no occupied cell far outside it, and
// some behind each of its pixels. Where the network is certain of a pixel's column, its prediction
// is kept. Elsewhere the network locates the surface only approximately: there a sheet is fitted
// through the columns, as smooth as the network's spread permits and about as thick as the
// silhouette is wide, since objects that are thin in the image are mostly thin along the line of
// sight. Reads `crop` and `logits`; fills `front_w` and `back_w`.
void EnforceSilhouetteConsistency(ShapePrediction* prediction);

}  // namespace simwright::asset_lift
