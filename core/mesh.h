#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/image.h"

namespace simwright::core {

// Triangles over shared vertices. Counter-clockwise seen from outside where the mesh is oriented.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;   // (N x 3), metres
  std::vector<Eigen::Vector3i> triangles;  // (M x 3), indices into `vertices`

  bool empty() const { return triangles.empty(); }
};

// What a surface looks like. `texture` multiplies `base_color` where it is there.
struct Material {
  std::string name;
  Eigen::Vector4f base_color{0.8f, 0.8f, 0.8f, 1.0f};  // RGBA, each in [0, 1], sRGB
  int texture = -1;                                    // index into TexturedMesh::textures, or -1
};

// A mesh as it is seen. The per-triangle arrays are empty or of length M, `corner_uvs` is empty
// or of length 3 M.
struct TexturedMesh {
  TriangleMesh mesh;
  std::vector<Eigen::Vector2f> corner_uvs;  // (3M x 2), origin at the image's lower left (OBJ)
  std::vector<int> triangle_material;       // (M) indices into `materials`
  std::vector<int> triangle_part;           // (M) indices into `part_names`
  std::vector<Material> materials;
  std::vector<std::string> part_names;
  std::vector<Image> textures;
};

// Throws core::Error, naming `where`, when an index is out of range, a coordinate is not finite,
// or a per-triangle array has another length.
void RequireValid(const TriangleMesh& mesh, const std::string& where);
void RequireValid(const TexturedMesh& mesh, const std::string& where);

// Axis-aligned bounds of the vertices; empty (isEmpty()) for a mesh without any.
Eigen::AlignedBox3d Bounds(const TriangleMesh& mesh);

// Twice the oriented area of a triangle times its unit normal.
Eigen::Vector3d TriangleAreaVector(const TriangleMesh& mesh, int triangle);

double SurfaceArea(const TriangleMesh& mesh);

// Vertices mapped by `target_from_source`; a mirroring map also turns the triangles round.
void Transform(const Eigen::Affine3d& target_from_source, TriangleMesh* mesh);

// Vertex normals, area-weighted, unit length or zero. (N x 3)
std::vector<Eigen::Vector3d> VertexNormals(const TriangleMesh& mesh);

// `addition` appended to `mesh`, indices shifted.
void Append(const TriangleMesh& addition, TriangleMesh* mesh);

// The texel of `texture` at `uv` (origin lower left, wrapping), bilinear, RGBA in [0, 1].
Eigen::Vector4f SampleTexture(const Image& texture, const Eigen::Vector2f& uv);

}  // namespace simwright::core
