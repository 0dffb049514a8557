#include "core/mesh.h"

#include <cmath>

#include "core/error.h"

namespace simwright::core {

void RequireValid(const TriangleMesh& mesh, const std::string& where) {
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!mesh.vertices[i].allFinite()) {
      throw Error("vertex " + std::to_string(i) + " is not a finite number", where,
                  "export the mesh again without NaN or infinite coordinates");
    }
  }
  const int count = static_cast<int>(mesh.vertices.size());
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& triangle = mesh.triangles[i];
    if (triangle.minCoeff() < 0 || triangle.maxCoeff() >= count) {
      throw Error("triangle " + std::to_string(i) + " refers to a missing vertex", where);
    }
  }
}

void RequireValid(const TexturedMesh& textured, const std::string& where) {
  RequireValid(textured.mesh, where);
  const size_t triangles = textured.mesh.triangles.size();
  if (!textured.corner_uvs.empty() && textured.corner_uvs.size() != 3 * triangles) {
    throw Error("texture coordinates do not match the triangles", where);
  }
  for (const auto* per_triangle : {&textured.triangle_material, &textured.triangle_part}) {
    if (!per_triangle->empty() && per_triangle->size() != triangles) {
      throw Error("a per-triangle list does not match the triangles", where);
    }
  }
  for (int material : textured.triangle_material) {
    if (material < 0 || material >= static_cast<int>(textured.materials.size())) {
      throw Error("a triangle refers to a missing material", where);
    }
  }
}

Eigen::AlignedBox3d Bounds(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return box;
}

Eigen::Vector3d TriangleAreaVector(const TriangleMesh& mesh, int triangle) {
  const Eigen::Vector3i& t = mesh.triangles[triangle];
  const Eigen::Vector3d& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

double SurfaceArea(const TriangleMesh& mesh) {
  double twice_area = 0.0;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    twice_area += TriangleAreaVector(mesh, static_cast<int>(i)).norm();
  }
  return 0.5 * twice_area;
}

void Transform(const Eigen::Affine3d& target_from_source, TriangleMesh* mesh) {
  for (Eigen::Vector3d& vertex : mesh->vertices) vertex = target_from_source * vertex;
  if (target_from_source.linear().determinant() < 0.0) {
    for (Eigen::Vector3i& triangle : mesh->triangles) std::swap(triangle[1], triangle[2]);
  }
}

std::vector<Eigen::Vector3d> VertexNormals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3d area = TriangleAreaVector(mesh, static_cast<int>(i));
    for (int k = 0; k < 3; ++k) normals[mesh.triangles[i][k]] += area;
  }
  for (Eigen::Vector3d& normal : normals) normal.stableNormalize();
  return normals;
}

void Append(const TriangleMesh& addition, TriangleMesh* mesh) {
  const int offset = static_cast<int>(mesh->vertices.size());
  mesh->vertices.insert(mesh->vertices.end(), addition.vertices.begin(), addition.vertices.end());
  mesh->triangles.reserve(mesh->triangles.size() + addition.triangles.size());
  for (const Eigen::Vector3i& triangle : addition.triangles) {
    mesh->triangles.push_back(triangle + Eigen::Vector3i::Constant(offset));
  }
}

Eigen::Vector4f SampleTexture(const Image& texture, const Eigen::Vector2f& uv) {
  const auto wrap = [](int i, int n) { return ((i % n) + n) % n; };
  // Texel centres are at half-integers; image rows run downwards, v upwards.
  const float x = (uv.x() - std::floor(uv.x())) * static_cast<float>(texture.width) - 0.5f;
  const float y =
      (1.0f - (uv.y() - std::floor(uv.y()))) * static_cast<float>(texture.height) - 0.5f;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (int dy = 0; dy < 2; ++dy) {
    for (int dx = 0; dx < 2; ++dx) {
      const float weight = (dx ? fx : 1.0f - fx) * (dy ? fy : 1.0f - fy);
      const std::uint8_t* p =
          texture.At(wrap(x0 + dx, texture.width), wrap(y0 + dy, texture.height));
      const auto channel = [&](int c) { return static_cast<float>(p[c]) / 255.0f; };
      switch (texture.channels) {
        case 1:
          sum += weight * Eigen::Vector4f(channel(0), channel(0), channel(0), 1.0f);
          break;
        case 3:
          sum += weight * Eigen::Vector4f(channel(0), channel(1), channel(2), 1.0f);
          break;
        default:
          sum += weight * Eigen::Vector4f(channel(0), channel(1), channel(2), channel(3));
      }
    }
  }
  return sum;
}

}  // namespace simwright::core
