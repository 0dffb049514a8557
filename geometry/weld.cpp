#include "geometry/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

struct CellHash {
  std::size_t operator()(const std::array<std::int64_t, 3>& cell) const {
    std::uint64_t h = 0x9E3779B97F4A7C15ull;
    for (const std::int64_t c : cell) {
      h ^= static_cast<std::uint64_t>(c) + 0x9E3779B97F4A7C15ull + (h << 6) + (h >> 2);
      h *= 0xBF58476D1CE4E5B9ull;
      h ^= h >> 29;
    }
    return static_cast<std::size_t>(h);
  }
};

std::vector<int> ExactRepresentatives(const std::vector<Vector3d>& vertices) {
  std::vector<int> order(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto less = [&](int a, int b) {
    const Vector3d& p = vertices[a];
    const Vector3d& q = vertices[b];
    if (p.x() != q.x()) return p.x() < q.x();
    if (p.y() != q.y()) return p.y() < q.y();
    if (p.z() != q.z()) return p.z() < q.z();
    return a < b;
  };
  std::sort(order.begin(), order.end(), less);
  std::vector<int> to(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    to[order[i]] = same ? to[order[i - 1]] : order[i];
  }
  return to;
}

// Maps each vertex to the first kept vertex within reach; kept vertices are farther apart than
// that.
std::vector<int> NearRepresentatives(const std::vector<Vector3d>& vertices, double tolerance) {
  std::unordered_map<std::array<std::int64_t, 3>, std::vector<int>, CellHash> cells;
  cells.reserve(vertices.size());
  std::vector<int> to(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    std::array<std::int64_t, 3> cell;
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = static_cast<std::int64_t>(std::floor(vertices[v][axis] / tolerance));
    }
    int found = -1;
    for (int n = 0; n < 27 && found < 0; ++n) {
      const auto it =
          cells.find({cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1});
      if (it == cells.end()) continue;
      for (const int other : it->second) {
        if ((vertices[other] - vertices[v]).squaredNorm() <= tolerance * tolerance) {
          found = other;
          break;
        }
      }
    }
    to[v] = found >= 0 ? found : static_cast<int>(v);
    if (found < 0) cells[cell].push_back(static_cast<int>(v));
  }
  return to;
}

int WeldRoot(std::vector<int>& parent, int x) {
  while (parent[x] != x) x = parent[x] = parent[parent[x]];
  return x;
}

}  // namespace

core::TriangleMesh Weld(const core::TriangleMesh& mesh, double tolerance) {
  return WeldWithOrigin(mesh, tolerance).mesh;
}

WeldedMesh WeldWithOrigin(const core::TriangleMesh& mesh, double tolerance) {
  core::RequireValid(mesh, "weld");
  const std::vector<int> to = tolerance > 0.0 ? NearRepresentatives(mesh.vertices, tolerance)
                                              : ExactRepresentatives(mesh.vertices);
  std::vector<Eigen::Vector3i> triangles;
  std::vector<int> sources;  // of `triangles`
  std::vector<std::pair<std::array<int, 3>, int>> keyed;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Eigen::Vector3i& t = mesh.triangles[f];
    const Eigen::Vector3i mapped(to[t[0]], to[t[1]], to[t[2]]);
    if (mapped[0] == mapped[1] || mapped[1] == mapped[2] || mapped[2] == mapped[0]) continue;
    std::array<int, 3> key = {mapped[0], mapped[1], mapped[2]};
    std::sort(key.begin(), key.end());
    keyed.emplace_back(key, static_cast<int>(triangles.size()));
    triangles.push_back(mapped);
    sources.push_back(static_cast<int>(f));
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<int> first(triangles.size());  // of the faces with the same vertices
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    const bool repeats = i > 0 && keyed[i].first == keyed[i - 1].first;
    first[keyed[i].second] = repeats ? first[keyed[i - 1].second] : keyed[i].second;
  }
  WeldedMesh result;
  core::TriangleMesh& welded = result.mesh;
  result.face_of.assign(mesh.triangles.size(), -1);
  std::vector<int> index(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    // The first of equal faces comes first, so that its face here is known.
    if (first[t] != static_cast<int>(t)) {
      result.face_of[sources[t]] = result.face_of[sources[first[t]]];
      continue;
    }
    result.face_of[sources[t]] = static_cast<int>(welded.triangles.size());
    Eigen::Vector3i corner;
    for (int c = 0; c < 3; ++c) {
      int& at = index[triangles[t][c]];
      if (at < 0) {
        at = static_cast<int>(welded.vertices.size());
        welded.vertices.push_back(mesh.vertices[triangles[t][c]]);
      }
      corner[c] = at;
    }
    welded.triangles.push_back(corner);
  }
  return result;
}

std::vector<EdgeUse> SortedEdgeUses(const core::TriangleMesh& mesh) {
  std::vector<std::size_t> start(mesh.vertices.size() + 1, 0);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int c = 0; c < 3; ++c) ++start[std::min(t[c], t[(c + 1) % 3]) + 1];
  }
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  std::vector<EdgeUse> uses(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t a = mesh.triangles[t][c];
      const std::uint32_t b = mesh.triangles[t][(c + 1) % 3];
      const std::uint64_t key = (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
      uses[next[std::min(a, b)]++] = {key, static_cast<int>(t), a < b};
    }
  }
  for (std::size_t v = 0; v + 1 < start.size(); ++v) {
    std::sort(uses.begin() + static_cast<std::ptrdiff_t>(start[v]),
              uses.begin() + static_cast<std::ptrdiff_t>(start[v + 1]),
              [](const EdgeUse& x, const EdgeUse& y) {
                return x.key != y.key ? x.key < y.key : x.triangle < y.triangle;
              });
  }
  return uses;
}

core::TriangleMesh WithoutUnusedVertices(const core::TriangleMesh& mesh) {
  core::TriangleMesh used;
  used.triangles = mesh.triangles;
  std::vector<int> index(mesh.vertices.size(), -1);
  for (Eigen::Vector3i& t : used.triangles) {
    for (int c = 0; c < 3; ++c) {
      int& at = index[t[c]];
      if (at < 0) {
        at = static_cast<int>(used.vertices.size());
        used.vertices.push_back(mesh.vertices[t[c]]);
      }
      t[c] = at;
    }
  }
  return used;
}

std::vector<int> EdgeComponents(const core::TriangleMesh& mesh, int* count) {
  const std::vector<EdgeUse> uses = SortedEdgeUses(mesh);
  std::vector<int> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (std::size_t i = 1; i < uses.size(); ++i) {
    if (uses[i].key != uses[i - 1].key) continue;
    const int a = WeldRoot(parent, uses[i - 1].triangle);
    const int b = WeldRoot(parent, uses[i].triangle);
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<int> component(mesh.triangles.size(), -1);
  int found = 0;
  for (std::size_t t = 0; t < parent.size(); ++t) {
    const int root = WeldRoot(parent, static_cast<int>(t));
    component[t] = root == static_cast<int>(t) ? found++ : component[root];
  }
  if (count != nullptr) *count = found;
  return component;
}

double SignedVolume(const core::TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0.0;
  const Vector3d reference = mesh.vertices[0];
  double six = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]] - reference;
    const Vector3d b = mesh.vertices[t[1]] - reference;
    const Vector3d c = mesh.vertices[t[2]] - reference;
    six += a.dot(b.cross(c));
  }
  return six / 6.0;
}

bool OrientConsistently(core::TriangleMesh* mesh) {
  const std::vector<EdgeUse> uses = SortedEdgeUses(*mesh);
  const std::size_t count = mesh->triangles.size();
  struct Link {
    int triangle;
    bool agrees;
  };
  std::vector<std::vector<Link>> links(count);
  std::vector<char> closed(count, 1);
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i;
    while (end < uses.size() && uses[end].key == uses[i].key) ++end;
    if (end - i == 2) {
      const bool agrees = uses[i].forward != uses[i + 1].forward;
      links[uses[i].triangle].push_back({uses[i + 1].triangle, agrees});
      links[uses[i + 1].triangle].push_back({uses[i].triangle, agrees});
    } else {
      for (std::size_t u = i; u < end; ++u) closed[uses[u].triangle] = 0;
    }
    i = end;
  }
  bool all_agree = true;
  std::vector<signed char> turn(count, -1);
  for (std::size_t start = 0; start < count; ++start) {
    if (turn[start] >= 0) continue;
    std::vector<int> patch{static_cast<int>(start)};
    turn[start] = 0;
    bool patch_closed = true;
    for (std::size_t next = 0; next < patch.size(); ++next) {
      const int t = patch[next];
      patch_closed = patch_closed && closed[t];
      for (const Link& link : links[t]) {
        const signed char wanted = static_cast<signed char>(link.agrees ? turn[t] : 1 - turn[t]);
        if (turn[link.triangle] < 0) {
          turn[link.triangle] = wanted;
          patch.push_back(link.triangle);
        } else if (turn[link.triangle] != wanted) {
          all_agree = false;
        }
      }
    }
    double six = 0.0;
    const Vector3d reference = mesh->vertices[mesh->triangles[start][0]];
    for (const int t : patch) {
      if (turn[t] == 1) std::swap(mesh->triangles[t][1], mesh->triangles[t][2]);
      const Eigen::Vector3i& corner = mesh->triangles[t];
      const Vector3d a = mesh->vertices[corner[0]] - reference;
      const Vector3d b = mesh->vertices[corner[1]] - reference;
      const Vector3d c = mesh->vertices[corner[2]] - reference;
      six += a.dot(b.cross(c));
    }
    if (patch_closed && six < 0.0) {
      for (const int t : patch) std::swap(mesh->triangles[t][1], mesh->triangles[t][2]);
    }
  }
  return all_agree;
}

}  // namespace simwright::geometry
