#pragma once

#include <filesystem>

namespace simwright::assets {

// Unpacks a zip with one mesh and its materials and textures into the existing `folder` and returns
// the path of the mesh: the only GLB, else the only OBJ, else the only PLY. Other files are not
// unpacked. Throws core::Error if the file is not a zip, has no such mesh or several, has more than
// 1000 entries, unpacks to more than 1 GiB, is damaged, or has an entry that leads outside.
std::filesystem::path ExtractMeshArchive(const std::filesystem::path& archive,
                                         const std::filesystem::path& folder);

}  // namespace simwright::assets
