#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/image.h"

namespace simwright::asset_lift {

class SalientNetwork;

// The segmented object of a photo.
struct Matte {
  core::Image alpha;   // 1 channel, as large as the photo; 255 inside the object
  std::string method;  // "alpha channel", "given mask", "the network FILE" or "colour and contrast"
  // The share of pixels in [0, 1] that the object covers, and its bounding box in pixels.
  double area = 0.0;
  int left = 0, top = 0, right = 0, bottom = 0;  // half-open
};

struct SegmentationOptions {
  // The longer side at which colour models are fitted; a larger one costs GrabCut time without a
  // better result.
  int working_side = 400;
  int grabcut_iterations = 5;
  double min_area = 0.004;  // of the image: smaller regions are specks
  double max_area = 0.96;   // a larger region leaves no background
  // A second region of at least this share of the largest one counts as a second object; a region
  // whose outline has contrast with the background counts from the smaller share on.
  double second_object = 0.35;
  double second_outlined = 0.1;
  // The maximum share of an object's outline that looks the same on both sides
  // (outline_contrast.h).
  double max_weak_outline = 0.5;
  int min_side = 32;  // pixels of the object's longer side
  // True if the object is known to be round: an ellipse supported by the photo's edges then
  // completes regions that shading hides.
  bool round_object = false;
  // Finds the object in place of colours and saliency (salient_network.h); may be null.
  std::shared_ptr<SalientNetwork> network;
  std::uint64_t seed = 1;
};

// Segments the single object of `photo`: by its alpha channel where it has one that is not opaque;
// otherwise by `mask` (any image with the same aspect ratio, bright inside); otherwise by
// `options.network`, with its outline refined by GrabCut and a guided filter; otherwise by the
// colours along the border (a Gaussian mixture), fine-grained saliency, GrabCut (Rother et al.
// 2004) and a guided filter. Throws core::Error with the reason where no single object stands out:
// no opaque pixel, no distinct region, an outline without contrast (an empty table, clear glass),
// two objects, an object cut off on several sides or under 32 pixels, a mask with another aspect
// ratio, or a photo under 16 pixels per side.
Matte SegmentObject(const core::Image& photo, const std::optional<core::Image>& mask,
                    const SegmentationOptions& options = {});

}  // namespace simwright::asset_lift
