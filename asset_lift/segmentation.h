#pragma once

#include <optional>
#include <string>

#include "core/image.h"

namespace simwright::asset_lift {

// The object of a photo, cut out.
struct Matte {
  core::Image alpha;   // 1 channel, as large as the photo; 255 inside the object
  std::string method;  // "alpha channel", "given mask" or "colour and contrast"
  // Share of pixels in [0, 1] that the object covers, and its box in pixels.
  double area = 0.0;
  int left = 0, top = 0, right = 0, bottom = 0;  // half-open
};

struct SegmentationOptions {
  // Longer side at which colour models are fitted; beyond it GrabCut's time grows, not its result.
  int working_side = 400;
  int grabcut_iterations = 5;
  double min_area = 0.004;  // of the picture: less is a speck
  double max_area = 0.96;   // more leaves no background to tell it from
  // A second region of this share of the largest one counts as a second object; one that is told
  // from the background by its outline does from the smaller share on.
  double second_object = 0.35;
  double second_outlined = 0.1;
  // More of the outline than this that looks the same on both sides is no object's
  // (outline_contrast.h).
  double most_weak_outline = 0.5;
  int least_side = 32;  // pixels of the object's longer side
  // The thing is known to be round: an ellipse with support in the photo's edges completes what
  // shade hides of it.
  bool round_object = false;
  std::uint64_t seed = 1;
};

// Finds the one object of `photo`: from its alpha channel where it has one that is not opaque;
// else from `mask` (any picture of the same proportions, bright inside); else by the colours along
// the border (a Gaussian mixture), fine-grained saliency, GrabCut (Rother et al. 2004) and a guided
// filter. Throws core::Error with the reason where no single object stands out: nothing opaque,
// nothing distinct, an outline without an edge (an empty table, clear glass), two objects, an object
// cut off on several sides or under 32 pixels, a mask of other proportions, or a photo under 16
// pixels a side.
Matte SegmentObject(const core::Image& photo, const std::optional<core::Image>& mask,
                    const SegmentationOptions& options = {});

}  // namespace simwright::asset_lift
