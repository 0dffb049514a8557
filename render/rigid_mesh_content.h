#pragma once

#include <vector>

#include "core/image.h"
#include "render/mesh_tree.h"
#include "render/rigid_mesh.h"
#include "render/shading_normals.h"

namespace simwright::render {

// The shading data of a triangle.
struct ShadedTriangle {
  TriangleNormals normals;  // mesh frame
  int material = 0;
};

struct ShadedMaterial {
  Eigen::Vector3f srgb, linear;  // the base colour
  int texture = -1;
};

struct RigidMesh::Content {
  Content(const std::vector<Eigen::Vector3f>& vertices, const core::TexturedMesh& mesh);

  MeshTree tree;
  Eigen::AlignedBox3f bounds;
  std::vector<ShadedTriangle> triangles;
  std::vector<ShadedMaterial> materials;
  std::vector<Eigen::Vector2f> corner_uvs;  // (3M), or empty
  std::vector<core::Image> textures;
  core::PbrLook look;
  // The corners of triangles whose look has a normal map, mesh frame, one per column; else empty.
  std::vector<Eigen::Matrix3f> corners;
};

// Returns the linear RGB of an sRGB value in [0, 1], and the sRGB byte of a linear value, clamped
// to [0, 1]: from tables, within 0.2 of a byte's step, and within one byte.
float TabulatedLinear(float srgb);
std::uint8_t TabulatedByte(float linear);

// Returns the albedo at barycentric coordinates (u, v) of a triangle, linear RGB.
Eigen::Vector3f LinearAlbedo(const RigidMesh::Content& mesh, int triangle, float u, float v);

}  // namespace simwright::render
