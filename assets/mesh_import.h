#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "core/mesh.h"

namespace simwright::assets {

// A mesh file as it is, in its own axes and units: OBJ, PLY, STL, glTF, GLB, DAE and what else
// Assimp reads. Polygons are triangulated; nodes become parts, placed by their transforms;
// materials keep colour and texture; lines, points and faces of zero area with repeated indices
// are dropped. Nothing is read from outside the file's folder: a texture that leads there, or that
// is missing or unreadable, is left out, and `warn` (may be empty) hears a sentence.
// Throws core::Error: missing, unknown, damaged, without faces, with coordinates that are not
// finite, more than 20 million faces.
core::TexturedMesh ReadMesh(const std::filesystem::path& path,
                            const std::function<void(const std::string&)>& warn = {});

// The "v" and "f" lines of one of our own OBJ files, index for index (Assimp would weld or split).
// Polygons are taken as fans. Throws core::Error when missing or malformed.
core::TriangleMesh ReadBareObj(const std::filesystem::path& path);

// Whether the file's ending is one of a mesh that ReadMesh takes.
bool HasMeshEnding(const std::filesystem::path& path);

}  // namespace simwright::assets
