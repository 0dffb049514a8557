#include "importers/t_junctions.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "importers/face_selection.h"
#include "importers/welded_surface.h"

namespace simwright::importers {
namespace {

using Eigen::Vector3d;

constexpr double kOnEdge = 1e-5;  // of the diagonal, the distance of a vertex from an edge
constexpr int kPasses = 6;        // each splits a face once
constexpr std::size_t kMostOpenEdges = 60000;

// An open edge of a face of the file, and a vertex on it.
struct TJunction {
  int face = 0;    // of the file
  int corner = 0;  // where the edge begins
  Vector3d point{0, 0, 0};
  double along = 0.0;  // share of the edge
};

// The vertices of open edges, for the query of those near a segment.
class OpenVertices {
 public:
  OpenVertices(const std::vector<Vector3d>& vertices, std::vector<int> open)
      : vertices_(vertices), open_(std::move(open)) {
    std::sort(open_.begin(), open_.end());
    open_.erase(std::unique(open_.begin(), open_.end()), open_.end());
    std::sort(open_.begin(), open_.end(),
              [&](int a, int b) { return vertices_[a].x() < vertices_[b].x(); });
  }

  // Returns the vertex nearest to the middle of the segment from a to b that lies on it, or -1;
  // `*along` receives its share of the segment.
  int VertexOn(int a, int b, double reach, double* along) const {
    const Vector3d& from = vertices_[a];
    const Vector3d way = vertices_[b] - from;
    const double length = way.squaredNorm();
    const double low = std::min(from.x(), vertices_[b].x()) - reach;
    const double high = std::max(from.x(), vertices_[b].x()) + reach;
    auto at = std::lower_bound(open_.begin(), open_.end(), low,
                               [&](int v, double x) { return vertices_[v].x() < x; });
    int found = -1;
    double off_middle = 0.5;
    for (; at != open_.end() && vertices_[*at].x() <= high; ++at) {
      const Vector3d offset = vertices_[*at] - from;
      const double share = offset.dot(way) / length;
      if (*at == a || *at == b || std::abs(share - 0.5) >= off_middle) continue;
      if ((offset - share * way).squaredNorm() > reach * reach) continue;
      if (std::min(share, 1.0 - share) * std::sqrt(length) <= reach) continue;
      found = *at;
      off_middle = std::abs(share - 0.5);
      *along = share;
    }
    return found;
  }

 private:
  const std::vector<Vector3d>& vertices_;
  std::vector<int> open_;  // by x
};

// Returns at most one junction per face.
std::vector<TJunction> FindJunctions(const core::TriangleMesh& source) {
  const geometry::WeldedMesh welded = WeldedSurface(source);
  const core::TriangleMesh& mesh = welded.mesh;
  std::vector<int> face_of(mesh.triangles.size(), -1);  // the first of the file's
  for (std::size_t f = welded.face_of.size(); f-- > 0;) {
    if (welded.face_of[f] >= 0) face_of[welded.face_of[f]] = static_cast<int>(f);
  }
  const std::vector<geometry::EdgeUse> uses = geometry::SortedEdgeUses(mesh);
  std::vector<geometry::EdgeUse> open;
  std::vector<int> vertices;
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i;
    while (end < uses.size() && uses[end].key == uses[i].key) ++end;
    if (end - i == 1) {
      open.push_back(uses[i]);
      vertices.push_back(static_cast<int>(uses[i].key >> 32));
      vertices.push_back(static_cast<int>(uses[i].key & 0xffffffffu));
    }
    i = end;
  }
  std::vector<TJunction> junctions;
  if (open.empty() || open.size() > kMostOpenEdges) return junctions;
  const OpenVertices candidates(mesh.vertices, std::move(vertices));
  const double reach = kOnEdge * core::Bounds(mesh).diagonal().norm();
  std::vector<char> split(mesh.triangles.size(), 0);
  for (const geometry::EdgeUse& use : open) {
    if (split[use.triangle]) continue;
    const Eigen::Vector3i& t = mesh.triangles[use.triangle];
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const std::uint64_t key = (static_cast<std::uint64_t>(std::min(a, b)) << 32) |
                                static_cast<std::uint64_t>(std::max(a, b));
      if (key != use.key) continue;
      TJunction junction{face_of[use.triangle], k};
      const int v = candidates.VertexOn(a, b, reach, &junction.along);
      if (v < 0) continue;
      junction.point = mesh.vertices[v];
      junctions.push_back(junction);
      split[use.triangle] = 1;
    }
  }
  return junctions;
}

// Splits the junction's face in two. A face keeps the order of its corners when it is welded.
void SplitFace(const TJunction& junction, core::TexturedMesh* mesh) {
  const std::size_t f = static_cast<std::size_t>(junction.face);
  const int from = junction.corner, to = (from + 1) % 3;
  const int middle = static_cast<int>(mesh->mesh.vertices.size());
  mesh->mesh.vertices.push_back(junction.point);
  Eigen::Vector3i second = mesh->mesh.triangles[f];
  mesh->mesh.triangles[f][to] = middle;
  second[from] = middle;
  AddFaceLike(junction.face, second, mesh);
  if (mesh->corner_uvs.empty()) return;
  const std::size_t added = mesh->corner_uvs.size() - 3;
  const float along = static_cast<float>(junction.along);
  const Eigen::Vector2f uv =
      (1.0f - along) * mesh->corner_uvs[3 * f + static_cast<std::size_t>(from)] +
      along * mesh->corner_uvs[3 * f + static_cast<std::size_t>(to)];
  for (std::size_t k = 0; k < 3; ++k) mesh->corner_uvs[added + k] = mesh->corner_uvs[3 * f + k];
  mesh->corner_uvs[3 * f + static_cast<std::size_t>(to)] = uv;
  mesh->corner_uvs[added + static_cast<std::size_t>(from)] = uv;
}

}  // namespace

void JoinTJunctions(const std::string& where, core::TexturedMesh* mesh, core::Findings* findings) {
  std::size_t count = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::vector<TJunction> junctions = FindJunctions(mesh->mesh);
    if (junctions.empty()) break;
    for (const TJunction& junction : junctions) SplitFace(junction, mesh);
    count += junctions.size();
  }
  if (count == 0) return;
  findings->push_back({"mesh-cracks-joined", core::Severity::kInfo, where,
                       std::to_string(count) + " faces were split at vertices of their neighbours "
                                               "that lay on their edges",
                       static_cast<double>(count)});
}

}  // namespace simwright::importers
