#pragma once

#include <vector>

#include "core/image.h"

namespace simwright::core {

// The part of a material beyond its base colour, in glTF's metallic-roughness model. The maps use
// the texture coordinates of the base colour, and are multiplied by the factors.
struct PbrMaterial {
  float metallic = 0.0f;      // [0, 1]
  float roughness = 1.0f;     // [0, 1]
  float normal_scale = 1.0f;  // of the x and y of the map's normals
  // Indices into PbrLook::images, or -1. Metallic and roughness maps are grey and linear; normals
  // are in tangent space, y up (as in OpenGL).
  int metallic_map = -1, roughness_map = -1, normal_map = -1;

  bool HasMaps() const { return metallic_map >= 0 || roughness_map >= 0 || normal_map >= 0; }
};

// The materials as a mesh's file states them, in the order of TexturedMesh::materials. Empty, or
// shorter than that list, where the file states nothing.
struct PbrLook {
  std::vector<PbrMaterial> materials;
  std::vector<Image> images;

  bool empty() const { return materials.empty(); }
};

}  // namespace simwright::core
