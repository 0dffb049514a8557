#pragma once

#include <cstdint>
#include <vector>

#include "capture/color_mixture.h"
#include "capture/mat_evidence.h"
#include "core/float_image.h"
#include "core/image.h"

namespace simwright::capture {

// The belief about a pixel before the cut: the cut keeps what is not merely likely. Colours are
// first learnt where a pixel is certainly or likely the one or the other.
enum class CutLabel : std::uint8_t { kBackground, kLikelyBackground, kLikelyObject, kObject };

struct MatCut {
  core::FloatImage inside;  // (H x W x 1) 1 is object
  // (H x W x 1) 1 where the photo's colour can as well be the mat's as the object's.
  core::FloatImage unsure;
};

// Separates the object from the mat by a minimum cut (Boykov and Kolmogorov 2004). Unlike GrabCut,
// which learns one distribution of colours for all of the background, a pixel of the mat is
// compared with the colour that the mat has there; the object's colours, and those beside the mat,
// are mixtures learnt from the photo (ColorMixture). Neighbours differ cheaply only across an edge
// that the mat's pattern does not explain. `photo`: H x W, RGB or RGBA; `evidence`: of a printed
// mat; `labels`: H x W, row by row; `others`: the object's colours in the other photos, or null.
// Throws core::Error if sizes differ, or for a photo without colours or under 2 pixels wide or
// high.
MatCut CutFromMat(const core::Image& photo, const MatEvidence& evidence,
                  const std::vector<CutLabel>& labels, const ColorMixture* others);

}  // namespace simwright::capture
