#pragma once

#include <filesystem>
#include <vector>

#include "twin/table_scene.h"

namespace simwright::twin {

// Reads the pictures in folders, or given as files, as photos of tables and backgrounds: RGB, at
// most 512 pixels a side, in the order of their names; other files are ignored. Throws core::Error
// for a path that does not exist, and for a folder without a picture.
std::vector<core::Image> ReadScenePhotos(const std::vector<std::filesystem::path>& paths);

// Returns the meshes that stand or lie on tables: 4 to 55 cm long, of at most 60,000 triangles; the
// middle of their base is moved to the origin.
std::vector<core::TexturedMesh> TableMeshes(std::vector<core::TexturedMesh> meshes);

}  // namespace simwright::twin
