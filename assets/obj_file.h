#pragma once

#include <filesystem>
#include <string>

#include "core/mesh.h"

namespace simwright::assets {

// Returns the Wavefront OBJ of a bare mesh, with 9 significant digits per coordinate (a micrometre
// on a kilometre), or 17 if `exact`.
std::string ObjText(const core::TriangleMesh& mesh, bool exact = false);

// Writes `STEM.obj`, `STEM.mtl` and the textures ("texture.png", or "texture_000.png" ... for
// several; with `shared_texture` one texture of that name) into `folder`. Parts become groups
// ("o NAME"), materials keep their names. PNG textures are copied unchanged. Throws core::Error if
// a file cannot be written.
void WriteVisual(const core::TexturedMesh& visual, const std::filesystem::path& folder,
                 const std::string& stem = "visual", const std::string& shared_texture = "");

// Returns the name of texture `index` out of `count`.
std::string TextureFileName(int index, int count);

}  // namespace simwright::assets
