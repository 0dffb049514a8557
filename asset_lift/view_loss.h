#pragma once

#include <vector>

#include "asset_lift/observed_view.h"
#include "render/differentiable.h"

namespace simwright::asset_lift {

// A view as a fit compares with it: small, its colours the object over black.
struct ViewTarget {
  core::Camera camera;
  core::FloatImage color;    // (H x W x 3), premultiplied by opacity; empty: none given
  core::FloatImage opacity;  // (H x W x 1)
  core::FloatImage depth;    // (H x W x 1), m, 0 unknown; empty: none given
  double area = 0.0;         // pixels of the object
};

// Averaged down so that the longer side has at most `max_side` pixels; the camera goes with it. A
// depth is kept where all that it is averaged from is known.
ViewTarget MakeTarget(const ObservedView& view, int max_side);

struct ViewLossWeights {
  double mask = 1.0, color = 1.0, depth = 1.0;
  double length = 1.0;  // m, by which depths are divided: the object's diagonal
};

// Squared differences a pixel of the object: coverage, colour (mean of the channels, both over
// black), and depth where picture and view are fully covered and the depth is known. Sets
// `gradient` to dL/d(picture); its images are empty where nothing was given.
double ViewLoss(const ViewTarget& target, const render::DifferentiableBuffers& picture,
                const ViewLossWeights& weights, render::DifferentiableBuffers* gradient);

// Intersection over union of the coverages (sum of the lesser over sum of the greater), [0, 1].
double MaskIou(const ViewTarget& target, const render::DifferentiableBuffers& picture);

// Mean absolute difference of the colours, channels averaged, a pixel of the object; 0 without.
double ColorError(const ViewTarget& target, const render::DifferentiableBuffers& picture);

}  // namespace simwright::asset_lift
