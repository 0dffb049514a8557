#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::texture {

struct AtlasOptions {
  int size = 1024;  // pixels per side; a power of two suits every renderer
  int padding = 2;  // pixels kept free around each chart, filled by dilation when baking
};

// Computes texture coordinates for any mesh without overlaps: six-way cube projection by normal (as
// in SF3D); connected regions become charts, triangles that would overlap others of their chart
// move to charts of their own; charts are packed on shelves at one texel density. Returns corner
// UVs (3M x 2) in [0, 1], origin at the lower left. Throws core::Error for an invalid mesh, or if
// even the smallest scale does not fit.
std::vector<Eigen::Vector2f> UnwrapToAtlas(const core::TriangleMesh& mesh,
                                           const AtlasOptions& options = {});

}  // namespace simwright::texture
