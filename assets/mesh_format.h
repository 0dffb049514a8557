#pragma once

#include <filesystem>
#include <string>

namespace simwright::assets {

enum class MeshFormat { kUnknown, kObj, kPly, kStl, kGlb, kGltf, kDae };

// Returns the format for the file's extension, upper or lower case.
MeshFormat MeshFormatOf(const std::filesystem::path& path);

// Returns the extension in lower case, with its dot.
std::string LowerCaseExtension(const std::filesystem::path& path);

// Returns the name of a known but unsupported format ("FBX") by its extension, otherwise an empty
// string.
std::string UnreadMeshFormat(const std::filesystem::path& path);

// Throws core::Error, naming the actual format and a remedy, if the file is missing or empty, its
// extension is that of an unsupported format (FBX, USD, STEP ...), or its first bytes are those of
// another format (a Git LFS pointer, a web page, an archive, a GLB called .obj).
void RequireMeshFile(const std::filesystem::path& path);

}  // namespace simwright::assets
