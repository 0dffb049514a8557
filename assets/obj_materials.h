#pragma once

#include <filesystem>
#include <vector>

#include "assets/mtl_file.h"
#include "assets/obj_text.h"
#include "assets/read_mesh.h"

namespace simwright::assets {

// The materials that an OBJ at `path` uses, in the order of obj.materials, from the libraries that
// it names (or STEM.mtl beside it). A library or a material that is missing is a finding.
std::vector<MtlMaterial> ReadObjMaterials(const std::filesystem::path& path, const ObjText& obj,
                                          FindingList* findings);

// A library for Assimp that names them "m0", "m1" ..., as obj.text does.
std::string NumberedLibrary(const std::vector<MtlMaterial>& materials);

}  // namespace simwright::assets
