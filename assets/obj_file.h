#pragma once

#include <filesystem>
#include <string>

#include "core/mesh.h"

namespace simwright::assets {

// Wavefront OBJ of a bare mesh; 9 significant digits a coordinate where `exact` is false
// (a micrometre on a kilometre), 17 where it is true.
std::string ObjText(const core::TriangleMesh& mesh, bool exact = false);

// Writes `STEM.obj`, `STEM.mtl` and the textures ("texture.png", or "texture_000.png" ... for
// several) into `folder`. Parts become groups ("o NAME"), materials keep their names. PNG textures
// stay as they are read. Throws core::Error when a file cannot be written.
void WriteVisual(const core::TexturedMesh& visual, const std::filesystem::path& folder,
                 const std::string& stem = "visual");

// Name of texture `index` out of `count`.
std::string TextureFileName(int index, int count);

}  // namespace simwright::assets
