#pragma once

#include <filesystem>

#include "assets/read_mesh.h"

namespace simwright::assets {

// Reads OBJ, STL and DAE with Assimp, in the file's own axes, in metres if a DAE gives its unit.
// Throws core::Error for a damaged file.
RawMesh ReadWithAssimp(const std::filesystem::path& path, FindingList* findings);

}  // namespace simwright::assets
