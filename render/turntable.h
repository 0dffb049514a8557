#pragma once

#include <vector>

#include "core/image.h"
#include "core/mesh.h"
#include "core/pbr_look.h"

namespace simwright::render {

struct TurntableOptions {
  int views = 4;                // evenly spaced around the vertical
  int size = 360;               // pixels per side
  double elevation = 0.42;      // rad above the horizon
  double first_azimuth = -1.2;  // rad from +x
  int samples_per_side = 3;
  const core::PbrLook* look = nullptr;  // the materials' reflection; null: Lambertian
};

// Renders the mesh from all sides, framed to its bounds, with ambient occlusion. RGBA.
std::vector<core::Image> Turntable(const core::TexturedMesh& mesh,
                                   const TurntableOptions& options = {});

// Renders the turntable's views in one row on white: an asset's preview.png.
core::Image Preview(const core::TexturedMesh& mesh, const TurntableOptions& options = {});

}  // namespace simwright::render
