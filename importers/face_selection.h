#pragma once

#include <vector>

#include "core/mesh.h"

namespace simwright::importers {

// Keeps the triangles for which `kept` (one value per triangle) is not 0, with their appearance,
// and removes the vertices that no longer have any.
void KeepFaces(const std::vector<char>& kept, core::TexturedMesh* mesh);

// Reverses the winding of the triangles for which `turned` is not 0.
void TurnFaces(const std::vector<char>& turned, core::TexturedMesh* mesh);

// Appends a triangle between vertices of the mesh with the part, material and coordinates of the
// triangle `like`: its first corner's, so that a texture gives it one colour.
void AddFaceLike(int like, const Eigen::Vector3i& corners, core::TexturedMesh* mesh);

}  // namespace simwright::importers
