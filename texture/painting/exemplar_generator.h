#pragma once

#include <cstdint>
#include <string>

#include "core/image.h"
#include "texture/image_generator.h"

namespace simwright::texture {

// A piece of a material's picture with its true size.
struct Swatch {
  core::Image picture;       // RGB, at least 32 pixels per side
  double pixel_size = 1e-3;  // m of the surface that a pixel shows
};

// Paints views with patches of a swatch by image quilting (Efros and Freeman, "Image quilting for
// texture synthesis and transfer", 2001): each patch is the one of many that fits what is beside it
// best, and is joined to it along the path of least difference. What the trimap keeps, and the
// surface painted before in what it regenerates, constrains the patches, so that views continue
// each other. The swatch has its true size on the surface at the object's mean depth.
class ExemplarGenerator : public ImageGenerator {
 public:
  // Throws core::Error for a swatch that is too small, or no RGB picture.
  explicit ExemplarGenerator(Swatch swatch);

  std::string name() const override { return "exemplar"; }
  core::Image Generate(const ImageRequest& request) override;

 private:
  Swatch swatch_;
};

// Returns the swatch with pixels of `pixel_size` (m), of 32 to 512 pixels per side: a pattern that
// would become smaller shows larger than it is.
Swatch Rescaled(const Swatch& swatch, double pixel_size);

// Returns the picture without its slow changes of brightness, which are shading: a swatch whose
// sides differ would show every patch.
core::Image WithoutShading(const core::Image& picture);

// Returns the largest square inside the bright part of `mask` (1 channel, the picture's size),
// eroded by 3 % of the object, as a picture of at most `side` pixels, and sets `scale` to its
// pixels per pixel of the picture. An empty mask means the whole picture. Throws core::Error if the
// square has fewer than 32 pixels per side.
core::Image LargestSwatch(const core::Image& picture, const core::Image& mask, int side,
                          double* scale);

}  // namespace simwright::texture
