#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/image.h"
#include "core/mesh.h"

namespace simwright::texture {

// The surface point of one texel.
struct SurfacePoint {
  int triangle = 0;
  Eigen::Vector3f barycentric{1, 0, 0};
  Eigen::Vector3d position{0, 0, 0};
  Eigen::Vector3d normal{0, 0, 1};  // of the face, unit
};

// Fills a texture of `size` pixels per side by calling `color` (RGB in [0, 1], sRGB; called from
// several threads) for each texel that a triangle covers, then dilates the charts by `dilation`
// texels so that bilinear lookups meet no gap. Uncovered texels take the mean colour.
core::Image BakeTexture(const core::TriangleMesh& mesh,
                        const std::vector<Eigen::Vector2f>& corner_uvs, int size, int dilation,
                        const std::function<Eigen::Vector3f(const SurfacePoint&)>& color);

}  // namespace simwright::texture
