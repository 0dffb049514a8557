#pragma once

#include <cstdint>
#include <string>

#include "core/image.h"
#include "core/mesh.h"
#include "render/light.h"
#include "texture/photo_projection.h"

namespace simwright::texture {

struct DelightingOptions {
  int pairs = 30'000;          // of pixels that the light is fitted to
  double chroma_scale = 0.02;  // difference of chromaticities at which a pair counts 0.6
  double edge_scale = 0.2;     // relative misfit at which a pair counts half: an albedo's edge
  // The ridge towards uniform light, relative to the pairs' weight, of bands 1 and 2.
  double band1_ridge = 0.0015, band2_ridge = 0.005;
  double least_shading = 0.2;  // relative to the mean: darker shading is divided out in part
  int occlusion_rays = 24;     // of a pixel
  int occlusion_side = 256;    // longer side of the picture in which openness is computed, pixels
  bool remove_highlights = true;
  std::uint64_t seed = 1;

  // Returns false, with the reason, unless all values can be used.
  bool IsValid(std::string* error) const;
};

// A photo without its shading.
struct DelitPhoto {
  core::Image albedo;  // RGB, sRGB, the photo's size; the photo itself outside the object
  // The fitted light, grey; the mean of its shading over the visible surface is 1.
  render::SphericalHarmonicsLight light;
  double contrast = 0.0;    // ratio of the 95th to the 5th percentile of the fitted shading
  double highlights = 0.0;  // share of the object's pixels that were replaced
};

// Estimates the light of a photo of a known shape, and divides its shading out. The light is grey,
// in spherical harmonics up to degree 2, dimmed by the ambient occlusion of the mesh. It is fitted
// to pairs of pixels of equal chromaticity, near ones and far ones: where two such pixels have one
// albedo, their colours have the ratio of their shadings. Pairs that disagree are edges of the
// albedo and lose their weight (iteratively reweighted least squares, Cauchy); a ridge keeps the
// light uniform where the surface does not show it. The scale of light and albedo cannot be told
// apart: the mean shading is 1, or larger if the albedo would be brighter than white. Highlights,
// where a pixel is brighter and less saturated than the albedo about it and the normal reflects the
// brighter side of the light, take that albedo.
//
// Requires a photo (1, 3 or 4 channels), a matte and a camera of one size and a mesh with faces.
// Throws core::Error otherwise, for options that are invalid, or if the camera sees nothing of the
// mesh inside the matte; throws core::Cancelled.
DelitPhoto DelightPhoto(const core::TriangleMesh& mesh, const PhotoView& view,
                        const DelightingOptions& options = {});

}  // namespace simwright::texture
