#pragma once

#include <filesystem>
#include <string>

#include "core/mesh.h"
#include "core/pbr_look.h"

namespace simwright::assets {

using core::PbrLook;
using core::PbrMaterial;

// Returns the mean metallic and roughness of a material: its factors times the means of its maps.
struct MeanReflection {
  double metallic = 0.0, roughness = 1.0;
};
MeanReflection MeanReflectionOf(const PbrLook& look, int material);

// Returns the material that covers most of the surface, by which formats of one material show the
// object; 0 if faces state none.
int MainMaterial(const core::TexturedMesh& visual);

// Adds the look to a written asset folder (docs/formats.md): the maps as PNG files, Pm, Pr and the
// maps to visual.mtl, "materials" to asset.json, specular and shininess of the main material to the
// MJCF `name`.xml (MuJoCo 2.2 has no metallic), and the material of a visual that has only one to
// the SDF `name`.sdf (<pbr><metal>; an SDF visual of several materials keeps those of visual.mtl).
// Does nothing for an empty look. Throws core::Error if a file of the folder is missing or damaged.
void AddPbrLook(const core::TexturedMesh& visual, const PbrLook& look, const std::string& name,
                const std::filesystem::path& folder);

// Returns the look that an asset folder states; empty for folders without "materials". Throws
// core::Error if a map is missing or a value is out of range.
PbrLook ReadPbrLook(const std::filesystem::path& folder);

}  // namespace simwright::assets
