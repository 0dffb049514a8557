#pragma once

#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "render/differentiable.h"

namespace simwright::asset_lift {

// A view as the target of a fit: scaled down, its colours the object over black.
struct ViewTarget {
  core::Camera camera;
  core::FloatImage color;    // (H x W x 3), premultiplied by opacity; empty: no colours
  core::FloatImage opacity;  // (H x W x 1)
  core::FloatImage depth;    // (H x W x 1), m, 0 unknown; empty: no depths
  double area = 0.0;         // the object's area in pixels
};

// Scales a view down by averaging so that the longer side has at most `max_side` pixels, and its
// camera with it. A depth is kept where all depths that it averages are known.
ViewTarget MakeTarget(const ObservedView& view, int max_side);

struct ViewLossWeights {
  double mask = 1.0, color = 1.0, depth = 1.0;
  double length = 1.0;  // m, the unit of depths: the object's diagonal
  // Differences of depths over this (m) count linearly, as in Huber's loss; 0: all are squared.
  double depth_tolerance = 0.0;
};

// Returns the squared differences per object pixel: coverage, colour (mean of the channels, both
// over black), and depth where image and view are fully covered and the depth is known. Sets
// `gradient` to dL/d(picture); its images are empty where the target has none.
double ViewLoss(const ViewTarget& target, const render::DifferentiableBuffers& picture,
                const ViewLossWeights& weights, render::DifferentiableBuffers* gradient);

// Returns the intersection over union of the coverages (sum of the minima over sum of the maxima),
// [0, 1].
double MaskIou(const ViewTarget& target, const render::DifferentiableBuffers& picture);

// Returns the mean absolute difference of the colours, channels averaged, per object pixel; 0
// without colours.
double ColorError(const ViewTarget& target, const render::DifferentiableBuffers& picture);

}  // namespace simwright::asset_lift
