#pragma once

#include "capture/capture.h"
#include "core/finding.h"

namespace simwright::capture {

// The disagreement of photos about the colours of the hull's surface.
struct ColorContradiction {
  // The share of the surface points that three photos or more show, of which they show different
  // colours (more than kSpread apart in CIELAB, after exposure and white balance).
  double share = 0.0;
  double median_spread = 0.0;  // CIELAB, of all those points
  int points = 0;
  // Views (indices) that agree with each other, but not with the rest; empty unless the views fall
  // into two such groups.
  std::vector<int> group;
};

// Measures the contradiction of the capture's views on its hull.
ColorContradiction MeasureContradiction(const Capture& capture);

// Returns warnings about captures whose asset is probably wrong although the outlines agree:
// several bodies on the mat ("other-objects"), a hull that reaches the mat's edge ("mat-covered"),
// and photos that show different colours of the same surface ("colors-contradict"), as those of
// mirrors, clear glass and two exchanged objects do. `print_scale`: the printed mat's true length
// over its nominal one.
core::Findings CaptureDoubts(const CaptureSource& source, const Capture& capture,
                             double print_scale);

}  // namespace simwright::capture
