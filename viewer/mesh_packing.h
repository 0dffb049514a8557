#pragma once

#include <string>
#include <vector>

#include "core/mesh.h"

namespace simwright::viewer {

// Consecutive triangles of one material.
struct TriangleGroup {
  int first = 0, count = 0;  // triangles
  int material = 0;
};

// A mesh as the page's graphics library takes it. `bytes`, little-endian, holds one after the
// other: positions (vertices x 3 float32, m), normals (vertices x 4 int8, the last 0), with
// `has_uvs` texture coordinates (vertices x 2 float32, origin lower left), and vertex indices
// (triangles x 3 uint32).
struct PackedMesh {
  int vertices = 0, triangles = 0;
  bool has_uvs = false;
  std::vector<TriangleGroup> groups;  // ascending by material; cover all triangles
  std::string bytes;
};

// Packs a valid mesh (core::RequireValid). The normal at a corner is the area-weighted mean over
// the triangles at its vertex whose normals lie within 40 degrees of its own triangle's: edges
// stay sharp, and curved surfaces are smooth. A vertex appears once for each pair of normal and
// texture coordinates at it.
PackedMesh PackMesh(const core::TexturedMesh& mesh);

}  // namespace simwright::viewer
