#pragma once

#include <filesystem>

#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::assets {

// A mesh file as it is: in its own axes, in metres where the format has a unit (glTF, DAE).
struct MeshFile {
  core::TexturedMesh mesh;
  // Axis that points up as the file itself says: 'x', 'y' or 'z' (<up_axis> of a DAE; glTF: 'y').
  // 0 where it says nothing (OBJ, PLY, STL, a DAE without <up_axis>).
  char up = 0;
  // What the file says and was not read, was found elsewhere or guessed, each with its remedy.
  core::Findings findings;
};

// Reads OBJ, PLY, STL, glTF 2.0, GLB and DAE (docs/formats.md lists what is read of each).
// Polygons are triangulated; nodes become parts, placed by their transforms; materials keep colour
// and texture; colours at vertices and faces become materials or a texture; lines, points and faces
// with repeated indices are dropped. No name inside the file leads out of its folder, but to a
// folder of textures beside it (`FindTextureFile`); what is missing or unreadable is a finding.
// Throws core::Error: missing, of another format (named, with what to do), damaged, compressed by
// what is not read, without faces, with coordinates that are not finite, more than 20 million
// faces.
MeshFile ReadMeshFile(const std::filesystem::path& path);

// The mesh of ReadMeshFile alone.
core::TexturedMesh ReadMesh(const std::filesystem::path& path);

// The turn of a file's axes that makes its `up` axis ('x', 'y' or 'z') point along z: y to z about
// x, x to z about y.
Eigen::Matrix3d ZUpFrom(char up);

// The "v" and "f" lines of one of our own OBJ files, index for index (Assimp would weld or split).
// Polygons are triangulated. Throws core::Error when missing or malformed.
core::TriangleMesh ReadBareObj(const std::filesystem::path& path);

// Whether the file's ending is one of a mesh that ReadMesh takes.
bool HasMeshEnding(const std::filesystem::path& path);

}  // namespace simwright::assets
