#include "assets/broken_faces.h"

#include <algorithm>
#include <string>
#include <vector>

namespace simwright::assets {
namespace {

constexpr double kMostBroken = 0.05;

// Keeps the groups of `size` values of the triangles that are not broken.
template <typename Value>
void KeepWhole(const std::vector<char>& broken, size_t size, std::vector<Value>* values) {
  if (values->empty()) return;
  size_t end = 0;
  for (size_t t = 0; t < broken.size(); ++t) {
    if (broken[t]) continue;
    for (size_t k = 0; k < size; ++k) (*values)[end++] = (*values)[size * t + k];
  }
  values->resize(end);
}

// Removes the vertices that no triangle uses.
void DropUnusedVertices(core::TriangleMesh* mesh) {
  std::vector<int> index(mesh->vertices.size(), -1);
  std::vector<Eigen::Vector3d> used;
  for (Eigen::Vector3i& t : mesh->triangles) {
    for (int k = 0; k < 3; ++k) {
      int& at = index[static_cast<size_t>(t[k])];
      if (at < 0) {
        at = static_cast<int>(used.size());
        used.push_back(mesh->vertices[static_cast<size_t>(t[k])]);
      }
      t[k] = at;
    }
  }
  mesh->vertices.swap(used);
}

}  // namespace

void DropBrokenFaces(RawMesh* raw, FindingList* findings) {
  core::TexturedMesh& mesh = raw->mesh;
  const int vertices = static_cast<int>(mesh.mesh.vertices.size());
  if (std::all_of(mesh.mesh.vertices.begin(), mesh.mesh.vertices.end(),
                  [](const Eigen::Vector3d& v) { return v.allFinite(); })) {
    return;
  }
  std::vector<char> broken(mesh.mesh.triangles.size(), 0);
  for (size_t t = 0; t < broken.size(); ++t) {
    for (const int v : mesh.mesh.triangles[t]) {
      if (v < 0 || v >= vertices) return;  // refused below for its indices
      broken[t] |= !mesh.mesh.vertices[static_cast<size_t>(v)].allFinite();
    }
  }
  const auto count = std::count(broken.begin(), broken.end(), 1);
  if (static_cast<double>(count) > kMostBroken * static_cast<double>(broken.size())) return;
  KeepWhole(broken, 1, &mesh.mesh.triangles);
  KeepWhole(broken, 1, &mesh.triangle_material);
  KeepWhole(broken, 1, &mesh.triangle_part);
  KeepWhole(broken, 3, &mesh.corner_uvs);
  KeepWhole(broken, 3, &raw->corner_colors);
  DropUnusedVertices(&mesh.mesh);
  findings->Add(core::Severity::kWarning, "mesh-lost-vertices",
                std::to_string(count) + " faces with coordinates that are not finite were left out",
                "export the mesh again", static_cast<double>(count));
}

}  // namespace simwright::assets
