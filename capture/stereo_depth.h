#pragma once

#include <cstdint>
#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "capture/patch_match.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::capture {

struct StereoOptions {
  PatchMatchOptions match;
  int neighbors = 5;         // views that a view is compared with, at most ...
  double least_angle = 8.0;  // ... whose directions to the object differ by these angles, deg
  double best_angle = 22.0;
  double most_angle = 60.0;
  int blur_radius = 8;       // pixels, of the mean that is subtracted from the colours
  double agreement = 0.008;  // diagonals: depths of two views that differ by less agree
  int least_agreeing = 2;    // other views that must agree
  int least_supporters = 3;  // of the eight neighbours of a pixel, with a depth close to its own
  std::uint64_t seed = 1;
};

// The depths that stereo finds.
struct StereoDepths {
  // One per view, (H x W x 1), m along the optical axis; 0: unknown.
  std::vector<core::FloatImage> depths;
  double share = 0.0;  // of the views' object pixels that have a depth
};

// Finds the depths of textured surfaces by comparing each view with its neighbours (PatchMatch):
// only those that at least two other views confirm are kept, so a plain object has none. The
// surface lies inside `hull` (world, m). Views without colours have no depths. Throws core::Error
// for an empty hull; core::Cancelled.
StereoDepths FindStereoDepths(const std::vector<asset_lift::ObservedView>& views,
                              const core::TriangleMesh& hull, const StereoOptions& options,
                              core::Progress* progress);

}  // namespace simwright::capture
