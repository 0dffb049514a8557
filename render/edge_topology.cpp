#include "render/edge_topology.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace simwright::render {
namespace {

std::vector<int> FirstAtPosition(const std::vector<Eigen::Vector3d>& points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto before = [&](int i, int j) {
    const Eigen::Vector3d &p = points[i], &q = points[j];
    if (p.x() != q.x()) return p.x() < q.x();
    if (p.y() != q.y()) return p.y() < q.y();
    if (p.z() != q.z()) return p.z() < q.z();
    return i < j;
  };
  std::sort(order.begin(), order.end(), before);
  std::vector<int> first(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && points[order[i]] == points[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

struct EdgeUse {
  int low, high;     // welded vertices
  int face, corner;  // the edge runs from this corner to the next
  bool operator<(const EdgeUse& other) const {
    if (low != other.low) return low < other.low;
    if (high != other.high) return high < other.high;
    return face != other.face ? face < other.face : corner < other.corner;
  }
};

std::vector<EdgeUse> SortedUses(const EdgeTopology& topology) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * topology.welded_triangles.size());
  for (std::size_t f = 0; f < topology.welded_triangles.size(); ++f) {
    const Eigen::Vector3i& t = topology.welded_triangles[f];
    for (int k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3];
      if (from == to) continue;
      uses.push_back({std::min(from, to), std::max(from, to), static_cast<int>(f), k});
    }
  }
  std::sort(uses.begin(), uses.end());
  return uses;
}

// Returns true if two texture coordinates differ by more than an integer.
bool Differs(const Eigen::Vector2f& p, const Eigen::Vector2f& q) {
  const Eigen::Vector2f d = p - q;
  return std::abs(d.x() - std::round(d.x())) > 1e-5f || std::abs(d.y() - std::round(d.y())) > 1e-5f;
}

// Returns the corners of a use's face at the edge's lower and higher end.
std::pair<int, int> Corners(const EdgeUse& use, const EdgeTopology& topology) {
  const int next = (use.corner + 1) % 3;
  const bool forward = topology.welded_triangles[use.face][use.corner] == use.low;
  return forward ? std::pair(use.corner, next) : std::pair(next, use.corner);
}

bool ColorSteps(const DifferentiableObject& object, const EdgeTopology& topology,
                const EdgeUse& one, const EdgeUse& other) {
  const auto [one_low, one_high] = Corners(one, topology);
  const auto [other_low, other_high] = Corners(other, topology);
  const int ends[2][2] = {{one_low, other_low}, {one_high, other_high}};
  for (const auto& [i, j] : ends) {
    if (!object.vertex_colors.empty() &&
        object.vertex_colors[object.mesh.triangles[one.face][i]] !=
            object.vertex_colors[object.mesh.triangles[other.face][j]]) {
      return true;
    }
    if (!object.texture.empty() &&
        Differs(object.corner_uvs[3 * one.face + i], object.corner_uvs[3 * other.face + j])) {
      return true;
    }
  }
  return false;
}

}  // namespace

EdgeTopology FindEdges(const DifferentiableObject& object, bool flat_shading) {
  EdgeTopology topology;
  topology.welded = FirstAtPosition(object.mesh.vertices);
  topology.welded_triangles.reserve(object.mesh.triangles.size());
  for (const Eigen::Vector3i& t : object.mesh.triangles) {
    topology.welded_triangles.emplace_back(topology.welded[t[0]], topology.welded[t[1]],
                                           topology.welded[t[2]]);
  }
  const std::vector<EdgeUse> uses = SortedUses(topology);
  topology.closed = true;
  for (std::size_t i = 0, end = 0; i < uses.size(); i = end) {
    const EdgeUse& use = uses[i];
    const auto [low, high] = Corners(use, topology);
    MeshEdge edge;
    edge.a = object.mesh.triangles[use.face][low];
    edge.b = object.mesh.triangles[use.face][high];
    edge.first = static_cast<int>(topology.faces.size());
    for (end = i; end < uses.size() && uses[end].low == use.low && uses[end].high == use.high;
         ++end) {
      const EdgeUse& at = uses[end];
      topology.faces.push_back({at.face, topology.welded_triangles[at.face][at.corner] == at.low});
    }
    edge.count = static_cast<int>(end - i);
    edge.crease =
        edge.count >= 2 && (flat_shading || ColorSteps(object, topology, use, uses[i + 1]));
    topology.closed = topology.closed && edge.count >= 2;
    topology.edges.push_back(edge);
  }
  return topology;
}

}  // namespace simwright::render
