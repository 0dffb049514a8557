#pragma once

#include <filesystem>

#include "tests/importers/damaged/mesh_damage.h"

namespace simwright::damaged {

// Writes the specimen as FOLDER/NAME.EXT in its format and returns the path. GLB files have y up.
std::filesystem::path WriteSpecimen(const Specimen& specimen, const std::string& name,
                                    const std::filesystem::path& folder);

}  // namespace simwright::damaged
