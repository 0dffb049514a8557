#pragma once

#include <filesystem>
#include <string>

namespace simwright::assets {

enum class MeshFormat { kUnknown, kObj, kPly, kStl, kGlb, kGltf, kDae };

// The format by the file's ending, upper or lower case.
MeshFormat MeshFormatOf(const std::filesystem::path& path);

// The ending in lower case, with its dot.
std::string LowerEnding(const std::filesystem::path& path);

// The name of a format that is known by its ending and not read ("FBX"), else empty.
std::string UnreadMeshFormat(const std::filesystem::path& path);

// Throws core::Error, naming what the file is and what to do, where it is missing or empty, its
// ending is that of a format which is not read (FBX, USD, STEP ...), or its first bytes are those
// of something else (a Git LFS pointer, a web page, an archive, a GLB called .obj).
void RequireMeshFile(const std::filesystem::path& path);

}  // namespace simwright::assets
