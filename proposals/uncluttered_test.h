#pragma once

#include <cstdint>
#include <string>

#include "core/image.h"

namespace simwright::proposals {

// The limits of the test that keeps pictures of one whole object before an even background.
struct UnclutteredLimits {
  double least_area = 0.03, largest_area = 0.75;  // of the picture, that the object covers
  double most_border = 0.02;       // share of the picture's border pixels that the object touches
  double second_component = 0.03;  // area of a second object, relative to the largest
  // The root mean square of the background's colours (sRGB, 1 is white) about a plane per channel,
  // which allows a gradient.
  double most_unevenness = 0.08;
};

// The outcome of the test, with the figures that it compares.
struct UnclutteredResult {
  bool kept = false;
  std::string reason;  // why it was refused; empty if kept
  double area = 0.0, border = 0.0, second = 0.0, unevenness = 0.0;
};

// Applies the test to a picture: its object is found as `simwright lift` finds it
// (asset_lift::SegmentObject), and refusals of that search are refusals here. Never throws for a
// picture with pixels, except core::Cancelled.
UnclutteredResult TestUncluttered(const core::Image& picture, std::uint64_t seed = 1,
                                  const UnclutteredLimits& limits = {});

}  // namespace simwright::proposals
