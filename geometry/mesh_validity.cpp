#include "geometry/mesh_validity.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/nested_components.h"
#include "geometry/self_intersection.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

void ExamineEdges(const core::TriangleMesh& mesh, MeshValidity* result) {
  const std::vector<EdgeUse> uses = SortedEdgeUses(mesh);
  result->closed = true;
  result->oriented = true;
  for (std::size_t i = 0; i < uses.size();) {
    int balance = 0;
    std::size_t end = i;
    for (; end < uses.size() && uses[end].key == uses[i].key; ++end) {
      balance += uses[end].forward ? 1 : -1;
    }
    const std::size_t faces = end - i;
    if (faces == 1) ++result->open_edges;
    if (faces > 2) ++result->non_manifold_edges;
    if (faces % 2 == 1) result->closed = false;
    if (faces > 1 && balance != 0) result->oriented = false;
    i = end;
  }
}

// Counts the vertices whose faces form more than one fan, joined through edges at the vertex.
int CountNonManifoldVertices(const core::TriangleMesh& mesh) {
  std::vector<int> start(mesh.vertices.size() + 1, 0);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int c = 0; c < 3; ++c) ++start[t[c] + 1];
  }
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<int> next = start;
  std::vector<int> corner(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int c = 0; c < 3; ++c) {
      corner[next[mesh.triangles[t][c]]++] = static_cast<int>(3 * t) + c;
    }
  }
  int bad = 0;
  std::vector<int> group;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const int faces = start[v + 1] - start[v];
    if (faces < 2) continue;
    group.assign(faces, 0);
    std::vector<int> fan{0};
    group[0] = 1;
    for (std::size_t at = 0; at < fan.size(); ++at) {
      const int own = corner[start[v] + fan[at]];
      const Eigen::Vector3i& t = mesh.triangles[own / 3];
      const int a = t[(own % 3 + 1) % 3];
      const int b = t[(own % 3 + 2) % 3];
      for (int f = 0; f < faces; ++f) {
        if (group[f]) continue;
        const int other = corner[start[v] + f];
        const Eigen::Vector3i& u = mesh.triangles[other / 3];
        const int c = u[(other % 3 + 1) % 3];
        const int d = u[(other % 3 + 2) % 3];
        if (a == c || a == d || b == c || b == d) {
          group[f] = 1;
          fan.push_back(f);
        }
      }
    }
    if (static_cast<int>(fan.size()) < faces) ++bad;
  }
  return bad;
}

// Returns true if each component faces outward, or inward if it bounds a hollow of another.
bool FacesOutward(const core::TriangleMesh& mesh, const std::vector<int>& component, int count) {
  const std::vector<double> volumes = ComponentVolumes(mesh, component, count);
  const std::vector<int> winding = EnclosingWindingNumbers(mesh, component, count);
  for (int c = 0; c < count; ++c) {
    if (volumes[c] > 0.0 ? winding[c] != 0 : winding[c] != 1) return false;
  }
  return true;
}

}  // namespace

MeshValidity Examine(const core::TriangleMesh& mesh, int intersection_limit) {
  core::RequireValid(mesh, "soundness");
  MeshValidity result;
  if (mesh.empty()) return result;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    if (IsDegenerate(mesh, t)) ++result.degenerate_triangles;
  }
  ExamineEdges(mesh, &result);
  result.non_manifold_vertices = CountNonManifoldVertices(mesh);
  result.manifold =
      result.open_edges == 0 && result.non_manifold_edges == 0 && result.non_manifold_vertices == 0;
  result.signed_volume = SignedVolume(mesh);
  const std::vector<int> component = EdgeComponents(mesh, &result.components);
  if (intersection_limit > 0) {
    result.self_intersections =
        static_cast<int>(SelfIntersections(mesh, intersection_limit).size());
  }
  // Enclosure is only defined between closed surfaces that do not intersect.
  if (result.closed && result.oriented) {
    result.oriented = result.self_intersections == 0
                          ? FacesOutward(mesh, component, result.components)
                          : result.signed_volume > 0.0;
  }
  return result;
}

std::string Describe(const MeshValidity& s) {
  std::string text = s.closed ? "closed" : std::to_string(s.open_edges) + " open edges";
  text += s.oriented ? ", oriented outward" : ", not oriented outward";
  if (s.non_manifold_edges + s.non_manifold_vertices > 0) {
    text += ", " + std::to_string(s.non_manifold_edges) + " non-manifold edges and " +
            std::to_string(s.non_manifold_vertices) + " non-manifold vertices";
  }
  text += ", " + std::to_string(s.self_intersections) + " self-intersections, " +
          std::to_string(s.components) + (s.components == 1 ? " component" : " components");
  if (s.degenerate_triangles > 0) {
    text += ", " + std::to_string(s.degenerate_triangles) + " degenerate triangles";
  }
  return text;
}

}  // namespace simwright::geometry
