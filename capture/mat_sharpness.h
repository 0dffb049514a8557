#pragma once

#include <string>
#include <vector>

#include "capture/mat_detection.h"
#include "core/finding.h"
#include "core/image.h"

namespace simwright::capture {

// Returns how far a photo smears the edges between the mat's squares: the median width of the step
// from dark to light, m on the mat at its nominal size. 0 if no edge is seen whole.
double EdgeWidthOnMat(const core::Image& photo, const MatObservation& mat);

// Returns the finding "photo-blurred" for the photos whose edges are wide in themselves and against
// the others' (`widths`, m; 0: unknown), or one finding if most photos are blurred.
core::Findings BlurredPhotos(const std::vector<double>& widths,
                             const std::vector<std::string>& names);

}  // namespace simwright::capture
