#pragma once

#include <filesystem>

#include "assets/pbr_look.h"
#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::assets {

// A mesh file's content: in its own axes, in metres if the format has a unit (glTF, DAE).
struct MeshFile {
  core::TexturedMesh mesh;
  // The up axis declared by the file: 'x', 'y' or 'z' (<up_axis> of a DAE; glTF: 'y'). 0 if it
  // declares none (OBJ, PLY, STL, a DAE without <up_axis>).
  char up = 0;
  // The content that was not read, found elsewhere or guessed, each with its remedy.
  core::Findings findings;
  // The materials as the file states them beyond the base colour (glTF).
  PbrLook look = {};
};

// Reads OBJ, PLY, STL, glTF 2.0, GLB and DAE (docs/formats.md lists the supported content).
// Polygons are triangulated; nodes become parts, placed by their transforms; materials keep colour
// and texture; vertex and face colours become materials or a texture; lines, points and faces with
// repeated indices are dropped. No name in the file may lead out of its folder, except to a texture
// folder beside it (`FindTextureFile`); missing or unreadable files are findings. Throws
// core::Error if the file is missing, of another format (named, with a remedy), damaged, compressed
// with an unsupported method, without faces, has more than 20 million faces, or where more than a
// twentieth of the faces have coordinates that are not finite (fewer are left out, with a finding).
MeshFile ReadMeshFile(const std::filesystem::path& path);

// Returns the mesh of ReadMeshFile alone.
core::TexturedMesh ReadMesh(const std::filesystem::path& path);

// Returns the rotation that maps a file's `up` axis ('x', 'y' or 'z') to z: y to z about x, x to z
// about y.
Eigen::Matrix3d ZUpRotation(char up);

// Reads the "v" and "f" lines of one of our own OBJ files with all indices preserved (Assimp would
// weld or split). Polygons are triangulated. Throws core::Error if the file is missing or
// malformed.
core::TriangleMesh ReadBareObj(const std::filesystem::path& path);

// Returns true if the file's extension is one that ReadMesh supports.
bool HasMeshExtension(const std::filesystem::path& path);

}  // namespace simwright::assets
