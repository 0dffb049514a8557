#include "geometry/manifold_split.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

// The corners of faces, joined where the faces share a fan.
class CornerFans {
 public:
  explicit CornerFans(const core::TriangleMesh& mesh)
      : mesh_(mesh), parent_(3 * mesh.triangles.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  void JoinAlong(const EdgeUse& one, const EdgeUse& other) {
    for (const std::uint64_t vertex : {one.key >> 32, one.key & 0xffffffffu}) {
      const int a = RootOf(CornerAt(one.triangle, static_cast<int>(vertex)));
      const int b = RootOf(CornerAt(other.triangle, static_cast<int>(vertex)));
      parent_[std::max(a, b)] = std::min(a, b);
    }
  }

  core::TriangleMesh Split() {
    core::TriangleMesh result;
    std::vector<int> vertex_of(parent_.size(), -1);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      Eigen::Vector3i corners;
      for (int k = 0; k < 3; ++k) {
        int& vertex = vertex_of[RootOf(3 * static_cast<int>(t) + k)];
        if (vertex < 0) {
          vertex = static_cast<int>(result.vertices.size());
          result.vertices.push_back(mesh_.vertices[mesh_.triangles[t][k]]);
        }
        corners[k] = vertex;
      }
      result.triangles.push_back(corners);
    }
    return result;
  }

 private:
  int CornerAt(int triangle, int vertex) const {
    const Eigen::Vector3i& t = mesh_.triangles[triangle];
    return 3 * triangle + (t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2);
  }
  int RootOf(int corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }

  const core::TriangleMesh& mesh_;
  std::vector<int> parent_;
};

// Returns the angle of a face around its edge, from the lower vertex to the higher one.
double AngleAround(const core::TriangleMesh& mesh, const EdgeUse& use) {
  const int low = static_cast<int>(use.key >> 32), high = static_cast<int>(use.key & 0xffffffffu);
  const Eigen::Vector3d axis = (mesh.vertices[high] - mesh.vertices[low]).normalized();
  int third = low;
  for (const int v : mesh.triangles[use.triangle]) third = v != low && v != high ? v : third;
  const Eigen::Vector3d side = mesh.vertices[third] - mesh.vertices[low];
  const Eigen::Vector3d first = axis.unitOrthogonal();
  return std::atan2(side.dot(axis.cross(first)), side.dot(first));
}

// Joins the faces of an edge that have the solid between them. Around the edge, a face that runs
// along it from the lower vertex has the solid at smaller angles, the others at larger ones.
void JoinAroundSolid(const core::TriangleMesh& mesh, const EdgeUse* begin, std::size_t count,
                     CornerFans* fans) {
  std::vector<std::pair<double, const EdgeUse*>> around;
  for (std::size_t i = 0; i < count; ++i)
    around.emplace_back(AngleAround(mesh, begin[i]), begin + i);
  std::sort(around.begin(), around.end());
  for (std::size_t i = 0; i < count; ++i) {
    const EdgeUse& one = *around[i].second;
    const EdgeUse& next = *around[(i + 1) % count].second;
    if (!one.forward && next.forward) fans->JoinAlong(one, next);
  }
}

}  // namespace

core::TriangleMesh SplitNonManifold(const core::TriangleMesh& mesh) {
  CornerFans fans(mesh);
  const std::vector<EdgeUse> uses = SortedEdgeUses(mesh);
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i;
    while (end < uses.size() && uses[end].key == uses[i].key) ++end;
    if (end - i == 2) {
      fans.JoinAlong(uses[i], uses[i + 1]);
    } else if (end - i > 2) {
      JoinAroundSolid(mesh, &uses[i], end - i, &fans);
    }
    i = end;
  }
  return fans.Split();
}

}  // namespace simwright::geometry
