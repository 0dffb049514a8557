#pragma once

#include "core/image.h"

namespace simwright::texture {

// The difference of two pictures of one object from one camera.
struct PerceptualDistance {
  // 1 - MS-SSIM of the luminance over five scales, fewer for pictures under 176 pixels (Wang,
  // Simoncelli and Bovik, "Multi-scale structural similarity", 2003): 0 for equal pictures.
  double structure = 0.0;
  double color = 0.0;  // mean difference in CIELAB (CIE76) where either shows the object
};

// Compares RGBA or RGB pictures of one size; transparent pixels count as white. Throws core::Error
// for other sizes or pictures under 16 pixels per side.
PerceptualDistance ComparePictures(const core::Image& a, const core::Image& b);

}  // namespace simwright::texture
