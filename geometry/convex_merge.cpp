#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "geometry/convex_hull.h"
#include "geometry/convex_pieces.h"
#include "geometry/distance.h"
#include "geometry/hull_simplify.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kTouching = 2e-3;  // of the diagonal: parts within this distance are neighbours
constexpr double kFarOff = 0.25;    // concavity from which a bound is enough to rank a merge
constexpr int kMostSeen = 80;       // pieces among which those apart are paired, too

struct Join {
  int a = 0, b = 0;
  double cost = 0.0;
};

// Returns true if the segment between the middles of two hulls runs inside the solid: they may have
// a common hull without excess although other pieces lie between them.
bool SeeEachOther(const Piece& a, const Piece& b, const CutContext& context) {
  constexpr int kSteps = 6;
  const Vector3d from = core::Bounds(a.hull).center(), to = core::Bounds(b.hull).center();
  for (int i = 0; i <= kSteps; ++i) {
    if (!context.fit->Inside(from + (to - from) * (static_cast<double>(i) / kSteps))) return false;
  }
  return true;
}

// Returns the cost of merging, or only a lower bound if it is above `enough`.
double JoinCost(const Piece& a, const Piece& b, double enough, const CutContext& context) {
  const Piece joined = JoinedPiece(a, b, context);
  return context.fit->Concavity(joined.hull, joined.volume, enough);
}

// Pairs each remaining piece with the few whose AABBs are nearest.
std::vector<Join> NearestPairs(const std::vector<Piece>& pieces, const std::vector<bool>& merged) {
  constexpr std::size_t kNearest = 4;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Piece& piece : pieces) boxes.push_back(core::Bounds(piece.hull));
  std::vector<Join> joins;
  for (int i = 0; i < static_cast<int>(pieces.size()); ++i) {
    if (merged[i]) continue;
    std::vector<std::pair<double, int>> others;
    for (int j = 0; j < static_cast<int>(pieces.size()); ++j) {
      if (j != i && !merged[j]) others.emplace_back(boxes[i].exteriorDistance(boxes[j]), j);
    }
    const std::size_t count = std::min(kNearest, others.size());
    std::partial_sort(others.begin(), others.begin() + count, others.end());
    for (std::size_t k = 0; k < count; ++k) {
      joins.push_back({std::min(i, others[k].second), std::max(i, others[k].second)});
    }
  }
  const auto ends = [](const Join& join) { return std::pair(join.a, join.b); };
  std::sort(joins.begin(), joins.end(),
            [&](const Join& x, const Join& y) { return ends(x) < ends(y); });
  joins.erase(std::unique(joins.begin(), joins.end(),
                          [&](const Join& x, const Join& y) { return ends(x) == ends(y); }),
              joins.end());
  return joins;
}

// Returns the pairs that may be merged, with their costs not measured.
std::vector<Join> MergeablePairs(const std::vector<Piece>& pieces, const CutContext& context) {
  const int n = static_cast<int>(pieces.size());
  std::vector<std::vector<int>> partners(n);
  core::ParallelFor(n, [&](int i) {
    for (int j = i + 1; j < n; ++j) {
      if (AreNeighbours(pieces[i], pieces[j], context) ||
          (n <= kMostSeen && SeeEachOther(pieces[i], pieces[j], context))) {
        partners[i].push_back(j);
      }
    }
  });
  std::vector<Join> joins;
  for (int i = 0; i < n; ++i) {
    for (const int j : partners[i]) joins.push_back({i, j});
  }
  return joins;
}

}  // namespace

bool AreNeighbours(const Piece& a, const Piece& b, const CutContext& context) {
  const double reach = kTouching * context.diagonal;
  if (core::Bounds(a.hull).exteriorDistance(core::Bounds(b.hull)) > reach) return false;
  return SignedDistance({a.hull.vertices, 0.0}, {b.hull.vertices, 0.0}).distance <= reach;
}

Piece JoinedPiece(const Piece& a, const Piece& b, const CutContext& context) {
  Piece joined;
  std::vector<Vector3d> points = a.hull.vertices;
  points.insert(points.end(), b.hull.vertices.begin(), b.hull.vertices.end());
  joined.hull = ThickenedConvexHull(points, context.options->min_thickness * context.diagonal);
  joined.hull_volume = SignedVolume(joined.hull);
  joined.volume = a.volume + b.volume;
  joined.concavity = -1.0;
  joined.cells = a.cells;
  joined.cells.insert(joined.cells.end(), b.cells.begin(), b.cells.end());
  return joined;
}

void MergePieces(const CutContext& context, double threshold, int max_parts,
                 std::vector<Piece>* pieces) {
  std::vector<Join> joins = MergeablePairs(*pieces, context);
  // Measures the costs of the pairs joins[first..] in parallel.
  const auto measure = [&](std::size_t first) {
    const bool all = max_parts > 0 && static_cast<int>(pieces->size()) > max_parts;
    core::ParallelFor(static_cast<int>(joins.size() - first), [&](int i) {
      Join& join = joins[first + i];
      join.cost = JoinCost((*pieces)[join.a], (*pieces)[join.b],
                           all ? std::max(kFarOff, threshold) : threshold, context);
    });
  };
  measure(0);
  int alive = static_cast<int>(pieces->size());
  std::vector<bool> merged(pieces->size(), false);
  while (true) {
    core::CheckCancelled();
    if (joins.empty()) {
      if (max_parts == 0 || alive <= max_parts) break;
      // If no bodies touch, the limit requires merging separated ones, too.
      joins = NearestPairs(*pieces, merged);
      if (joins.empty()) break;
      measure(0);
    }
    const auto best = std::min_element(
        joins.begin(), joins.end(), [](const Join& a, const Join& b) { return a.cost < b.cost; });
    if (best->cost > threshold && (max_parts == 0 || alive <= max_parts)) break;
    const Join join = *best;
    Piece joined = JoinedPiece((*pieces)[join.a], (*pieces)[join.b], context);
    joined.concavity = join.cost;
    merged[join.a] = merged[join.b] = true;
    --alive;
    std::vector<int> neighbours;
    for (const Join& other : joins) {
      for (const auto& [mine, far] : {std::pair{other.a, other.b}, std::pair{other.b, other.a}}) {
        if ((mine == join.a || mine == join.b) && !merged[far]) neighbours.push_back(far);
      }
    }
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    std::erase_if(joins, [&](const Join& other) { return merged[other.a] || merged[other.b]; });
    pieces->push_back(std::move(joined));
    merged.push_back(false);
    const std::size_t first = joins.size();
    for (const int n : neighbours) joins.push_back({n, static_cast<int>(pieces->size()) - 1});
    measure(first);
  }
  std::vector<Piece> remaining;
  for (std::size_t i = 0; i < pieces->size(); ++i) {
    if (!merged[i]) remaining.push_back(std::move((*pieces)[i]));
  }
  *pieces = std::move(remaining);
}

std::vector<core::TriangleMesh> MergeHulls(std::vector<core::TriangleMesh> parts, int max_parts,
                                           int max_vertices) {
  if (max_parts < 1) throw core::Error("at least one part must remain", "convex parts");
  struct Merge {
    core::TriangleMesh hull;
    double added = 0.0;  // m^3
  };
  const auto merge = [](const core::TriangleMesh& a, const core::TriangleMesh& b) {
    std::vector<Vector3d> points = a.vertices;
    points.insert(points.end(), b.vertices.begin(), b.vertices.end());
    Merge merged{ConvexHull(points)};
    merged.added = SignedVolume(merged.hull) - SignedVolume(a) - SignedVolume(b);
    return merged;
  };
  // added[i][j], j < i: of the parts that remain.
  std::vector<std::vector<double>> added(parts.size());
  core::ParallelFor(static_cast<int>(parts.size()), [&](int i) {
    if (static_cast<int>(parts.size()) <= max_parts) return;
    for (int j = 0; j < i; ++j) added[i].push_back(merge(parts[i], parts[j]).added);
  });
  while (static_cast<int>(parts.size()) > max_parts) {
    core::CheckCancelled();
    std::size_t a = 1, b = 0;
    for (std::size_t i = 1; i < parts.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (added[i][j] < added[a][b]) std::tie(a, b) = std::pair(i, j);
      }
    }
    parts[b] = SimplifyHull(merge(parts[a], parts[b]).hull, max_vertices);
    parts.erase(parts.begin() + static_cast<long>(a));
    added.erase(added.begin() + static_cast<long>(a));
    for (std::size_t i = a; i < added.size(); ++i) {
      added[i].erase(added[i].begin() + static_cast<long>(a));
    }
    core::ParallelFor(static_cast<int>(parts.size()), [&](int i) {
      const int merged = static_cast<int>(b);
      if (i == merged) return;
      added[std::max(i, merged)][std::min(i, merged)] = merge(parts[i], parts[b]).added;
    });
  }
  return parts;
}

}  // namespace simwright::geometry
