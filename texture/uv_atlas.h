#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::texture {

struct AtlasOptions {
  int size = 1024;  // pixels per side; a power of two suits every renderer
  int padding = 2;  // pixels kept free around each chart, filled by dilation when baking
};

// Computes texture coordinates for any mesh without overlaps, by xatlas: charts grow over similar
// normals, are flattened with little change of angles, and are packed at one texel density. No
// chart is mirrored. A triangle without area gets the coordinates of one point. Returns corner UVs
// (3M x 2) in [0, 1], origin at the lower left. Throws core::Error for an invalid mesh, or if even
// the smallest scale does not fit.
std::vector<Eigen::Vector2f> UnwrapToAtlas(const core::TriangleMesh& mesh,
                                           const AtlasOptions& options = {});

}  // namespace simwright::texture
