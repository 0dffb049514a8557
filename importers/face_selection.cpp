#include "importers/face_selection.h"

#include <utility>

#include "geometry/weld.h"

namespace simwright::importers {
namespace {

// Keeps the groups of `size` values for which `kept` is not 0.
template <typename Value>
void KeepValues(const std::vector<char>& kept, std::size_t size, std::vector<Value>* values) {
  if (values->empty()) return;
  std::vector<Value> rest;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    if (!kept[t]) continue;
    for (std::size_t k = 0; k < size; ++k) rest.push_back((*values)[size * t + k]);
  }
  values->swap(rest);
}

}  // namespace

void KeepFaces(const std::vector<char>& kept, core::TexturedMesh* mesh) {
  KeepValues(kept, 1, &mesh->mesh.triangles);
  KeepValues(kept, 1, &mesh->triangle_material);
  KeepValues(kept, 1, &mesh->triangle_part);
  KeepValues(kept, 3, &mesh->corner_uvs);
  mesh->mesh = geometry::WithoutUnusedVertices(mesh->mesh);
}

void TurnFaces(const std::vector<char>& turned, core::TexturedMesh* mesh) {
  for (std::size_t t = 0; t < turned.size(); ++t) {
    if (!turned[t]) continue;
    std::swap(mesh->mesh.triangles[t][1], mesh->mesh.triangles[t][2]);
    if (!mesh->corner_uvs.empty()) {
      std::swap(mesh->corner_uvs[3 * t + 1], mesh->corner_uvs[3 * t + 2]);
    }
  }
}

void AddFaceLike(int like, const Eigen::Vector3i& corners, core::TexturedMesh* mesh) {
  const std::size_t t = static_cast<std::size_t>(like);
  mesh->mesh.triangles.push_back(corners);
  if (!mesh->triangle_material.empty()) {
    mesh->triangle_material.push_back(static_cast<int>(mesh->triangle_material[t]));
  }
  if (!mesh->triangle_part.empty()) {
    mesh->triangle_part.push_back(static_cast<int>(mesh->triangle_part[t]));
  }
  if (!mesh->corner_uvs.empty()) {
    const Eigen::Vector2f uv = mesh->corner_uvs[3 * t];
    mesh->corner_uvs.insert(mesh->corner_uvs.end(), 3, uv);
  }
}

}  // namespace simwright::importers
