#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"
#include "core/mesh.h"
#include "core/progress.h"
#include "texture/image_generator.h"
#include "texture/painting/texel_map.h"

namespace simwright::texture {

struct PaintingOptions {
  std::string prompt, negative_prompt;
  core::Image exemplar;         // RGB, the look that is wanted; may be empty
  int view_size = 1024;         // pixels per side of a view's picture
  double refine_gain = 0.2;     // a view repaints what it sees squarer by this much (cosine)
  double least_facing = 0.15;   // a view paints no surface seen flatter than this (cosine)
  double front_azimuth = M_PI;  // rad from +x: the side of the first view
  std::uint64_t seed = 1;

  // Returns false, with the reason, for sizes outside 64 to 4096 or values that are no cosine.
  bool IsValid(std::string* error) const;
};

// A view of the loop, as it was painted.
struct PaintedView {
  core::Camera camera;
  core::Image trimap;                      // as in ImageRequest
  core::Image picture;                     // as the generator made it
  std::size_t generated = 0, refined = 0;  // texels painted first and again
};

// A texture with the account of how it came about.
struct Painting {
  core::Image texture;  // RGB, the map's size
  // (size x size) the view that painted a texel, in the order of painting; -1: no view saw it, and
  // it has the colours around it; -2: outside the charts.
  std::vector<std::int16_t> painted_by;
  std::vector<float> facing;  // (size x size) the cosine to that view; 0 where there is none
  std::vector<PaintedView> views;
  double unseen_share = 0.0;  // of the texels inside the charts
};

inline constexpr std::int16_t kUnseenTexel = -1, kNoTexel = -2;

// Returns the cameras of the loop in its order: eight from 30 degrees above the horizon at azimuths
// of 0, 45, 315, 90, 270, 135, 225 and 180 degrees from the front, then one from 60 degrees above
// and one from 60 degrees below (Richardson et al., "TEXTure: Text-guided texturing of 3D shapes",
// 2023). They see the whole box.
std::vector<core::Camera> PaintingCameras(const Eigen::AlignedBox3d& bounds, double front_azimuth,
                                          int size);

// Paints the texture of `mesh` (which needs unique texture coordinates) view by view. In each view
// a trimap says what to generate (not painted yet, grown by 1.6 % of the side), to refine (seen
// squarer by refine_gain than by the view that painted it) and to keep (the rest, and 0.3 % of the
// side along the outline). `generator` makes a picture of the view; each texel that the camera
// sees, and whose pixel is not to be kept, takes its colour from there, blended with what was
// painted towards the border of the repainted area. Texels that no view sees take the colours
// around them. The texture is continuous across the borders of charts, since texels on both sides
// of a border are the same surface point. Throws core::Error for invalid options or missing
// coordinates, whatever the generator throws, and core::Cancelled.
Painting PaintTexture(const core::TexturedMesh& mesh, const TexelMap& map,
                      const PaintingOptions& options, ImageGenerator* generator,
                      core::Progress* progress);

}  // namespace simwright::texture
