#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/mesh.h"

namespace simwright::assets {

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
  std::vector<core::Image> images;

  bool empty() const { return materials.empty(); }
};

// Returns the mean metallic and roughness of a material: its factors times the means of its maps.
struct MeanReflection {
  double metallic = 0.0, roughness = 1.0;
};
MeanReflection MeanReflectionOf(const PbrLook& look, int material);

// Returns the material that covers most of the surface, by which formats of one material show the
// object; 0 if faces state none.
int MainMaterial(const core::TexturedMesh& visual);

// Adds the look to a written asset folder (docs/formats.md): the maps as PNG files, Pm, Pr and the
// maps to visual.mtl, "materials" to asset.json, and specular and shininess of the main material
// to the MJCF `name`.xml (MuJoCo 2.2 has no metallic). Does nothing for an empty look. Throws
// core::Error if a file of the folder is missing or damaged.
void AddPbrLook(const core::TexturedMesh& visual, const PbrLook& look, const std::string& name,
                const std::filesystem::path& folder);

// Returns the look that an asset folder states; empty for folders without "materials". Throws
// core::Error if a map is missing or a value is out of range.
PbrLook ReadPbrLook(const std::filesystem::path& folder);

}  // namespace simwright::assets
