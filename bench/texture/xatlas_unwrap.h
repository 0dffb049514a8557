#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"
#include "texture/uv_atlas.h"

namespace simwright::bench {

// The settings of xatlas that are compared.
struct XatlasTuning {
  bool turn = false;      // charts may be transposed, which mirrors their texture
  bool search = false;    // each chart's place is searched, not guessed 4096 times
  bool blocks = false;    // charts stand on multiples of 4 texels, which shortens the search
  int iterations = 1;     // of the charts' growth
  double max_cost = 2.0;  // of a chart's growth
};

// Unwraps by xatlas to the margins and the size of `options`, as texture::UnwrapToAtlas.
std::vector<Eigen::Vector2f> XatlasUnwrap(const core::TriangleMesh& mesh,
                                          const texture::AtlasOptions& options,
                                          const XatlasTuning& tuning);

}  // namespace simwright::bench
