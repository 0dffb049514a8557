#pragma once

#include <filesystem>
#include <vector>

#include "assets/mtl_file.h"
#include "assets/obj_text.h"
#include "assets/read_mesh.h"

namespace simwright::assets {

// Returns the materials that an OBJ at `path` uses, in the order of obj.materials, from the
// libraries that it names (or STEM.mtl beside it). A missing library or material is a finding.
std::vector<MtlMaterial> ReadObjMaterials(const std::filesystem::path& path, const PreparedObj& obj,
                                          FindingList* findings);

// Returns a library for Assimp that names them "m0", "m1" ..., as in obj.text.
std::string NumberedLibrary(const std::vector<MtlMaterial>& materials);

}  // namespace simwright::assets
