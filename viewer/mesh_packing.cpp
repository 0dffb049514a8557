#include "viewer/mesh_packing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>

namespace simwright::viewer {
namespace {

constexpr double kCreaseCosine = 0.766;  // of 40 degrees

using PackedNormal = std::array<std::int8_t, 4>;

// The triangles at each vertex, as ranges of one array.
struct VertexTriangles {
  std::vector<int> begin;  // (vertices + 1)
  std::vector<int> triangle;
};

VertexTriangles TrianglesByVertex(const core::TriangleMesh& mesh) {
  VertexTriangles at;
  at.begin.assign(mesh.vertices.size() + 1, 0);
  for (const Eigen::Vector3i& corners : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++at.begin[static_cast<std::size_t>(corners[k]) + 1];
  }
  std::partial_sum(at.begin.begin(), at.begin.end(), at.begin.begin());
  at.triangle.resize(mesh.triangles.size() * 3);
  std::vector<int> next(at.begin.begin(), at.begin.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(mesh.triangles[t][k]);
      at.triangle[static_cast<std::size_t>(next[vertex]++)] = static_cast<int>(t);
    }
  }
  return at;
}

PackedNormal Packed(const Eigen::Vector3d& normal) {
  const double length = normal.norm();
  if (!(length > 0.0)) return {0, 0, 127, 0};
  PackedNormal packed = {};
  for (int i = 0; i < 3; ++i) {
    packed[static_cast<std::size_t>(i)] =
        static_cast<std::int8_t>(std::lround(127.0 * normal[i] / length));
  }
  return packed;
}

// The normals of all corners, by triangle and corner.
std::vector<PackedNormal> CornerNormals(const core::TriangleMesh& mesh) {
  const VertexTriangles at = TrianglesByVertex(mesh);
  std::vector<Eigen::Vector3d> areas(mesh.triangles.size()), units(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    areas[t] = core::TriangleAreaVector(mesh, static_cast<int>(t));
    const double length = areas[t].norm();
    units[t] = length > 0.0 ? Eigen::Vector3d(areas[t] / length) : Eigen::Vector3d::Zero();
  }
  std::vector<PackedNormal> normals(mesh.triangles.size() * 3);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(mesh.triangles[t][static_cast<int>(k)]);
      Eigen::Vector3d sum = areas[t];
      for (int i = at.begin[vertex]; i < at.begin[vertex + 1]; ++i) {
        const auto other = static_cast<std::size_t>(at.triangle[static_cast<std::size_t>(i)]);
        if (other != t && units[other].dot(units[t]) > kCreaseCosine) sum += areas[other];
      }
      normals[3 * t + k] = Packed(sum);
    }
  }
  return normals;
}

// A vertex of the packed mesh: a vertex of the source with a normal and texture coordinates.
struct PackedVertex {
  int vertex = 0;
  PackedNormal normal = {};
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();

  bool operator==(const PackedVertex& other) const {
    return vertex == other.vertex && normal == other.normal && uv == other.uv;
  }
};

// Returns the order of the triangles by material, and the groups.
std::vector<int> ByMaterial(const core::TexturedMesh& mesh, std::vector<TriangleGroup>* groups) {
  std::vector<int> order(mesh.mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  const auto material = [&](int triangle) {
    return mesh.triangle_material.empty()
               ? 0
               : std::max(0, mesh.triangle_material[static_cast<std::size_t>(triangle)]);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return material(a) < material(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (groups->empty() || groups->back().material != material(order[i])) {
      groups->push_back({static_cast<int>(i), 0, material(order[i])});
    }
    ++groups->back().count;
  }
  return order;
}

template <typename T>
void Write(const T* values, std::size_t count, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(values), sizeof(T) * count);
}

std::string Bytes(const core::TriangleMesh& mesh, const std::vector<PackedVertex>& vertices,
                  const std::vector<std::uint32_t>& indices, bool has_uvs) {
  std::string bytes;
  bytes.reserve(vertices.size() * (has_uvs ? 24 : 16) + indices.size() * 4);
  for (const PackedVertex& vertex : vertices) {
    const Eigen::Vector3f point =
        mesh.vertices[static_cast<std::size_t>(vertex.vertex)].cast<float>();
    Write(point.data(), 3, &bytes);
  }
  for (const PackedVertex& vertex : vertices) Write(vertex.normal.data(), 4, &bytes);
  if (has_uvs) {
    for (const PackedVertex& vertex : vertices) Write(vertex.uv.data(), 2, &bytes);
  }
  Write(indices.data(), indices.size(), &bytes);
  return bytes;
}

}  // namespace

PackedMesh PackMesh(const core::TexturedMesh& mesh) {
  PackedMesh packed;
  packed.has_uvs = !mesh.corner_uvs.empty() && !mesh.textures.empty();
  const std::vector<int> order = ByMaterial(mesh, &packed.groups);
  const std::vector<PackedNormal> normals = CornerNormals(mesh.mesh);
  std::vector<PackedVertex> vertices;
  std::vector<std::uint32_t> indices;
  indices.reserve(order.size() * 3);
  // The packed vertices of one source vertex form a list that begins at `first`.
  std::vector<int> first(mesh.mesh.vertices.size(), -1), next;
  for (const int triangle : order) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t corner = 3 * static_cast<std::size_t>(triangle) + k;
      PackedVertex wanted;
      wanted.vertex = mesh.mesh.triangles[static_cast<std::size_t>(triangle)][static_cast<int>(k)];
      wanted.normal = normals[corner];
      if (packed.has_uvs) wanted.uv = mesh.corner_uvs[corner];
      int& head = first[static_cast<std::size_t>(wanted.vertex)];
      int at = head;
      while (at >= 0 && !(vertices[static_cast<std::size_t>(at)] == wanted)) {
        at = next[static_cast<std::size_t>(at)];
      }
      if (at < 0) {
        at = static_cast<int>(vertices.size());
        vertices.push_back(wanted);
        next.push_back(head);
        head = at;
      }
      indices.push_back(static_cast<std::uint32_t>(at));
    }
  }
  packed.vertices = static_cast<int>(vertices.size());
  packed.triangles = static_cast<int>(order.size());
  packed.bytes = Bytes(mesh.mesh, vertices, indices, packed.has_uvs);
  return packed;
}

}  // namespace simwright::viewer
