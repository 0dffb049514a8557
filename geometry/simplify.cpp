#include "geometry/simplify.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "geometry/edge_collapse.h"
#include "geometry/mesh_validity.h"
#include "geometry/self_intersection.h"
#include "geometry/surface_distance.h"
#include "geometry/triangle_tree.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr int kAttempts = 8;
constexpr int kPairLimit = 5000;       // limits per attempt on repaired intersecting pairs
constexpr int kFarLimit = 5000;        // and on repaired points that are too far off
constexpr int kFewestSamples = 10000;  // per surface, to measure its distance from another

using Boxes = std::vector<Eigen::AlignedBox3d>;

// The limits of one simplification pass.
struct Limits {
  int budget = 0;             // faces
  double max_error = 0.0;     // see SimplifyOptions
  double max_distance = 0.0;  // see SimplifyOptions
};

// Returns the AABBs of intersecting faces of `mesh`.
Boxes IntersectingRegions(const core::TriangleMesh& mesh) {
  Boxes boxes;
  for (const auto& [s, t] : SelfIntersections(mesh, kPairLimit)) {
    Eigen::AlignedBox3d first, second;
    for (int c = 0; c < 3; ++c) {
      first.extend(mesh.vertices[mesh.triangles[s][c]]);
      second.extend(mesh.vertices[mesh.triangles[t][c]]);
    }
    const Eigen::AlignedBox3d box = first.intersection(second);
    boxes.push_back(box.isEmpty() ? first : box);
  }
  return boxes;
}

// Appends AABBs that span each point farther than `limit` from `mesh` and its nearest surface
// point.
void AppendSimplifyDistant(const std::vector<Vector3d>& points, const core::TriangleMesh& mesh,
                           double limit, Boxes* boxes) {
  const TriangleTree tree(mesh);
  std::vector<char> far(points.size());
  constexpr int kBlock = 4096;
  const int count = static_cast<int>(points.size());
  core::ParallelFor((count + kBlock - 1) / kBlock, [&](int block) {
    core::CheckCancelled();
    for (int i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
      far[i] = !tree.Within(points[i], limit);
    }
  });
  const std::size_t every = 1 + std::count(far.begin(), far.end(), 1) / kFarLimit;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!far[i] || seen++ % every != 0) continue;
    Eigen::AlignedBox3d box(points[i]);
    boxes->push_back(box.extend(tree.Closest(points[i]).point));
  }
}

// Returns the AABBs at which the two surfaces are farther apart than `limit`.
Boxes DistantRegions(const core::TriangleMesh& source, const Thinned& result, double limit) {
  std::vector<char> kept(source.vertices.size());
  for (const int s : result.sources) {
    if (s >= 0) kept[s] = 1;
  }
  std::vector<Vector3d> removed;
  for (std::size_t v = 0; v < kept.size(); ++v) {
    if (!kept[v]) removed.push_back(source.vertices[v]);
  }
  // Sample the interior of large faces, too.
  const int samples = std::max<int>(kFewestSamples, static_cast<int>(removed.size()));
  const std::vector<Vector3d> inside = SampleSurface(source, kFewestSamples, 2);
  removed.insert(removed.end(), inside.begin(), inside.end());
  Boxes boxes;
  AppendSimplifyDistant(removed, result.mesh, limit, &boxes);
  AppendSimplifyDistant(SampleSurface(result.mesh, samples, 1), source, limit, &boxes);
  return boxes;
}

// Locks the vertices of `source` within `reach` of one of the boxes.
void LockAround(const core::TriangleMesh& source, const Boxes& boxes, double reach,
                std::vector<char>* locked) {
  Boxes wider;
  for (const Eigen::AlignedBox3d& box : boxes) {
    wider.emplace_back(box.min() - Vector3d::Constant(reach),
                       box.max() + Vector3d::Constant(reach));
  }
  std::sort(wider.begin(), wider.end(),
            [](const auto& a, const auto& b) { return a.min().x() < b.min().x(); });
  for (std::size_t v = 0; v < source.vertices.size(); ++v) {
    if ((*locked)[v]) continue;
    for (const Eigen::AlignedBox3d& box : wider) {
      if (box.min().x() > source.vertices[v].x()) break;
      if (box.contains(source.vertices[v])) {
        (*locked)[v] = 1;
        break;
      }
    }
  }
}

Thinned Unchanged(const core::TriangleMesh& source) {
  Thinned same{source, std::vector<int>(source.vertices.size())};
  std::iota(same.sources.begin(), same.sources.end(), 0);
  return same;
}

// Runs one simplification pass, repeated with more locked vertices until no faces intersect and no
// point is too far off.
Thinned SimplifyPass(const core::TriangleMesh& source, const Limits& limits,
                     std::vector<char> locked) {
  double edge = 0.0;
  for (const Eigen::Vector3i& t : source.triangles) {
    edge += (source.vertices[t[0]] - source.vertices[t[1]]).norm();
  }
  double reach = 2.0 * edge / static_cast<double>(source.triangles.size());
  for (int tries = 0; tries < kAttempts; ++tries, reach *= 1.6) {
    Thinned result = CollapseEdges(source, locked, limits.budget, limits.max_error);
    for (int t = 0; t < static_cast<int>(result.mesh.triangles.size()); ++t) {
      if (IsDegenerate(result.mesh, t)) return Unchanged(source);
    }
    Boxes wrong = IntersectingRegions(result.mesh);
    if (limits.max_distance > 0.0) {
      const Boxes far = DistantRegions(source, result, limits.max_distance);
      wrong.insert(wrong.end(), far.begin(), far.end());
    }
    if (wrong.empty()) return result;
    LockAround(source, wrong, reach, &locked);
  }
  return Unchanged(source);
}

constexpr int kBlockFaces = 40000;  // fits into a core's cache with its quadrics

// Groups faces into blocks that are close in space: along a space-filling curve (Morton) over their
// centroids.
std::vector<std::vector<int>> FaceBlocks(const core::TriangleMesh& mesh) {
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  const double scale = 1023.0 / std::max(box.sizes().maxCoeff(), 1e-300);
  std::vector<std::pair<std::uint32_t, int>> order(mesh.triangles.size());
  for (std::size_t t = 0; t < order.size(); ++t) {
    const Eigen::Vector3i& c = mesh.triangles[t];
    const Vector3d at =
        scale *
        ((mesh.vertices[c[0]] + mesh.vertices[c[1]] + mesh.vertices[c[2]]) / 3.0 - box.min());
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t cell = static_cast<std::uint32_t>(std::clamp(at[axis], 0.0, 1023.0));
      for (int bit = 0; bit < 10; ++bit) code |= (cell >> bit & 1u) << (3 * bit + axis);
    }
    order[t] = {code, static_cast<int>(t)};
  }
  std::sort(order.begin(), order.end());
  std::vector<std::vector<int>> blocks((order.size() + kBlockFaces - 1) / kBlockFaces);
  for (std::size_t i = 0; i < order.size(); ++i) {
    blocks[i / kBlockFaces].push_back(order[i].second);
  }
  return blocks;
}

// Simplifies a mesh in independent blocks of faces.
class BlockSimplifier {
 public:
  explicit BlockSimplifier(const core::TriangleMesh& mesh)
      : mesh_(mesh), blocks_(FaceBlocks(mesh)), owner_(mesh.vertices.size(), kNobody) {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      for (const int t : blocks_[b]) {
        for (int c = 0; c < 3; ++c) {
          int& owner = owner_[mesh.triangles[t][c]];
          owner = owner == kNobody || owner == static_cast<int>(b) ? static_cast<int>(b) : kShared;
        }
      }
    }
  }

  // Simplifies each block to its limits and keeps the blocks' shared vertices. If faces of two
  // blocks come to intersect, both blocks stay unchanged.
  core::TriangleMesh Run(const Limits& limits) {
    std::vector<Thinned> thinned(blocks_.size());
    core::ParallelFor(static_cast<int>(blocks_.size()),
                      [&](int b) { thinned[b] = SimplifiedBlock(b, limits); });
    for (int tries = 0; tries < kAttempts; ++tries) {
      std::vector<int> block;  // block of each face
      core::TriangleMesh joined = Join(thinned, &block);
      const auto pairs = SelfIntersections(joined, kPairLimit);
      if (pairs.empty()) return joined;
      for (const auto& [s, t] : pairs) {
        for (const int b : {block[s], block[t]}) thinned[b] = Whole(Part(b));
      }
    }
    return mesh_;
  }

 private:
  static constexpr int kNobody = -1;
  static constexpr int kShared = -2;

  // One block, and for each of its vertices the index in the mesh.
  struct BlockPart {
    core::TriangleMesh mesh;
    std::vector<int> original;
  };

  BlockPart Part(int b) const {
    BlockPart part;
    std::unordered_map<int, int> index;
    for (const int t : blocks_[b]) {
      Eigen::Vector3i corner;
      for (int c = 0; c < 3; ++c) {
        const int v = mesh_.triangles[t][c];
        const auto [entry, fresh] =
            index.try_emplace(v, static_cast<int>(part.mesh.vertices.size()));
        corner[c] = entry->second;
        if (!fresh) continue;
        part.mesh.vertices.push_back(mesh_.vertices[v]);
        part.original.push_back(v);
      }
      part.mesh.triangles.push_back(corner);
    }
    return part;
  }

  static Thinned Whole(BlockPart part) { return {std::move(part.mesh), std::move(part.original)}; }

  Thinned SimplifiedBlock(int b, const Limits& limits) const {
    const BlockPart part = Part(b);
    std::vector<char> locked;
    for (const int v : part.original) locked.push_back(owner_[v] == kShared);
    Thinned thinned = SimplifyPass(part.mesh, limits, locked);
    for (int& s : thinned.sources) s = s < 0 ? -1 : part.original[s];
    return thinned;
  }

  core::TriangleMesh Join(const std::vector<Thinned>& thinned, std::vector<int>* block) const {
    core::TriangleMesh joined;
    std::unordered_map<int, int> shared;
    for (std::size_t b = 0; b < thinned.size(); ++b) {
      std::vector<int> index;
      for (std::size_t v = 0; v < thinned[b].mesh.vertices.size(); ++v) {
        const int at = static_cast<int>(joined.vertices.size());
        const int source = thinned[b].sources[v];
        const bool common = source >= 0 && owner_[source] == kShared;
        index.push_back(common ? shared.try_emplace(source, at).first->second : at);
        if (index.back() == at) joined.vertices.push_back(thinned[b].mesh.vertices[v]);
      }
      for (const Eigen::Vector3i& t : thinned[b].mesh.triangles) {
        joined.triangles.emplace_back(index[t[0]], index[t[1]], index[t[2]]);
        block->push_back(static_cast<int>(b));
      }
    }
    return joined;
  }

  const core::TriangleMesh& mesh_;
  const std::vector<std::vector<int>> blocks_;
  std::vector<int> owner_;  // block of each vertex, or kShared
};

}  // namespace

core::TriangleMesh Simplify(const core::TriangleMesh& mesh, const SimplifyOptions& options) {
  const MeshValidity state = Examine(mesh, 0);
  if (mesh.empty() || !state.closed || !state.manifold) {
    throw core::Error("only a closed, manifold mesh can be simplified", "simplify",
                      "make it a solid first");
  }
  // Simplify in steps, so that repeating one is cheap. The first step collapses nearly flat
  // regions, which hardly ever makes faces intersect.
  const double error = options.max_error;
  const double distance = options.max_distance;
  core::TriangleMesh result = mesh;
  if (error > 0.0 && static_cast<int>(mesh.triangles.size()) > 2 * kBlockFaces) {
    result = BlockSimplifier(mesh).Run({0, 0.15 * error, distance});
  }
  const int halfway = std::max(4 * options.face_budget, 4);
  const int budget = std::max(options.face_budget, 4);
  const std::array<Limits, 3> steps = {Limits{halfway, 0.15 * error, distance},
                                       Limits{halfway, error, distance},
                                       Limits{budget, error, distance}};
  for (const Limits& limits : steps) {
    if (static_cast<int>(result.triangles.size()) <= limits.budget) continue;
    result = SimplifyPass(result, limits, std::vector<char>(result.vertices.size(), 0)).mesh;
  }
  return result;
}

}  // namespace simwright::geometry
