#include "asset_lift/mesh_fit/self_intersection_smoothing.h"

#include <vector>

#include "core/progress.h"
#include "geometry/self_intersection.h"

namespace simwright::asset_lift {
namespace {

std::vector<std::vector<int>> Neighbours(const core::TriangleMesh& mesh) {
  std::vector<std::vector<int>> neighbours(mesh.vertices.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) neighbours[t[k]].push_back(t[(k + 1) % 3]);
  }
  return neighbours;
}

// Returns flags for the vertices of intersecting or degenerate faces.
std::vector<char> FaultyVertices(const core::TriangleMesh& mesh) {
  std::vector<char> faulty(mesh.vertices.size(), 0);
  const auto mark = [&](int triangle) {
    for (int k = 0; k < 3; ++k) faulty[mesh.triangles[triangle][k]] = 1;
  };
  for (const auto& [one, other] : geometry::SelfIntersections(mesh, 100000)) {
    mark(one);
    mark(other);
  }
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (geometry::IsDegenerate(mesh, static_cast<int>(f))) mark(static_cast<int>(f));
  }
  return faulty;
}

}  // namespace

bool SmoothSelfIntersections(core::TriangleMesh* mesh, int rounds) {
  const std::vector<std::vector<int>> neighbours = Neighbours(*mesh);
  for (int round = 0;; ++round) {
    core::CheckCancelled();
    std::vector<char> moving = FaultyVertices(*mesh);
    bool any = false;
    for (const char m : moving) any = any || m;
    if (!any) return true;
    if (round == rounds) return false;
    for (int ring = 0; ring < 1 + round / 3; ++ring) {
      std::vector<char> wider = moving;
      for (std::size_t v = 0; v < moving.size(); ++v) {
        if (!moving[v]) continue;
        for (const int n : neighbours[v]) wider[n] = 1;
      }
      moving = wider;
    }
    for (int pass = 0; pass < 3; ++pass) {
      const std::vector<Eigen::Vector3d> before = mesh->vertices;
      for (std::size_t v = 0; v < moving.size(); ++v) {
        if (!moving[v] || neighbours[v].empty()) continue;
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        for (const int n : neighbours[v]) mean += before[n];
        mesh->vertices[v] =
            0.5 * before[v] + 0.5 * mean / static_cast<double>(neighbours[v].size());
      }
    }
  }
}

}  // namespace simwright::asset_lift
