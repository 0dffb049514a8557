#pragma once

#include <filesystem>

#include "assets/read_mesh.h"

namespace simwright::assets {

// Reads OBJ, STL and DAE with Assimp, in the file's own axes, metres where a DAE says its unit.
// Throws core::Error where it is damaged.
RawMesh ReadByAssimp(const std::filesystem::path& path, FindingList* findings);

}  // namespace simwright::assets
