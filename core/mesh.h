#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/image.h"

namespace simwright::core {

// An indexed triangle mesh. Triangles are counter-clockwise seen from outside if it is oriented.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;   // (N x 3), metres
  std::vector<Eigen::Vector3i> triangles;  // (M x 3), indices into `vertices`

  bool empty() const { return triangles.empty(); }
};

// The appearance of a surface. `texture`, if any, multiplies `base_color`.
struct Material {
  std::string name;
  Eigen::Vector4f base_color{0.8f, 0.8f, 0.8f, 1.0f};  // RGBA, each in [0, 1], sRGB
  int texture = -1;                                    // index into TexturedMesh::textures, or -1
};

// A mesh with its appearance. The per-triangle arrays are empty or of length M, `corner_uvs` is
// empty or of length 3 M.
struct TexturedMesh {
  TriangleMesh mesh;
  std::vector<Eigen::Vector2f> corner_uvs;  // (3M x 2), origin at the image's lower left (OBJ)
  std::vector<int> triangle_material;       // (M) indices into `materials`
  std::vector<int> triangle_part;           // (M) indices into `part_names`
  std::vector<Material> materials;
  std::vector<std::string> part_names;
  std::vector<Image> textures;
};

// Throws core::Error, naming `where`, if an index is out of range, a coordinate is not finite, or a
// per-triangle array has another length.
void RequireValid(const TriangleMesh& mesh, const std::string& where);
void RequireValid(const TexturedMesh& mesh, const std::string& where);

// Returns the AABB of the vertices; empty (isEmpty()) if there are none.
Eigen::AlignedBox3d Bounds(const TriangleMesh& mesh);

// Returns the unit normal of a triangle times twice its area.
Eigen::Vector3d TriangleAreaVector(const TriangleMesh& mesh, int triangle);

double SurfaceArea(const TriangleMesh& mesh);

// Transforms the vertices by `target_from_source`. A reflection also flips the triangles' winding.
void Transform(const Eigen::Affine3d& target_from_source, TriangleMesh* mesh);

// Returns the area-weighted vertex normals, unit length or zero. (N x 3)
std::vector<Eigen::Vector3d> VertexNormals(const TriangleMesh& mesh);

// Appends `addition` to `mesh`, with its indices shifted.
void Append(const TriangleMesh& addition, TriangleMesh* mesh);

// Samples `texture` bilinearly at `uv` (origin lower left, wrapping): RGBA in [0, 1].
Eigen::Vector4f SampleTexture(const Image& texture, const Eigen::Vector2f& uv);

}  // namespace simwright::core
