#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "assets/gltf_document.h"
#include "assets/gltf_materials.h"

namespace simwright::assets {

// A primitive's triangles in the mesh's own frame, before skin and node.
struct GltfPrimitive {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector2f> uvs;      // of the material's TEXCOORD, or empty
  std::vector<CornerColor> colors;       // COLOR_0, sRGB, or empty
  std::vector<std::uint32_t> triangles;  // three indices each
  // The joints and weights, `influences` per vertex; empty without a skin.
  std::vector<std::uint32_t> joints;
  std::vector<float> weights;
  size_t influences = 0;
};

// Reads a primitive with the morph target `weights`. Returns nothing if it has no triangles
// (points, lines).
std::optional<GltfPrimitive> ReadGltfPrimitive(const GltfDocument& document,
                                               const core::Json& source,
                                               const GltfMaterial& material,
                                               const std::vector<double>& weights, bool skinned);

}  // namespace simwright::assets
