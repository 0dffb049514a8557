#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/progress.h"
#include "geometry/convex_hull.h"
#include "geometry/convex_pieces.h"
#include "geometry/distance.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kTouching = 2e-3;  // of the diagonal: parts within this distance are neighbours

struct Join {
  int a = 0, b = 0;
  double cost = 0.0;
};

bool Touching(const Piece& a, const Piece& b, double reach) {
  return SignedDistance({a.hull.vertices, 0.0}, {b.hull.vertices, 0.0}).distance <= reach;
}

Piece Joined(const Piece& a, const Piece& b, const CutContext& context) {
  Piece joined;
  std::vector<Vector3d> points = a.hull.vertices;
  points.insert(points.end(), b.hull.vertices.begin(), b.hull.vertices.end());
  joined.hull = ThickenedConvexHull(points, context.options->min_thickness * context.diagonal);
  joined.hull_volume = SignedVolume(joined.hull);
  joined.volume = a.volume + b.volume;
  joined.concavity = -1.0;
  return joined;
}

// Returns the cost of merging, or only a lower bound if it is above `enough`.
double JoinCost(const Piece& a, const Piece& b, double enough, const CutContext& context) {
  const Piece joined = Joined(a, b, context);
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

}  // namespace

void MergePieces(const CutContext& context, double threshold, int max_parts,
                 std::vector<Piece>* pieces) {
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<Join> joins;
  // Measures the costs of the pairs joins[first..] in parallel.
  const auto measure = [&](std::size_t first) {
    const bool all = max_parts > 0 && static_cast<int>(pieces->size()) > max_parts;
    core::ParallelFor(static_cast<int>(joins.size() - first), [&](int i) {
      Join& join = joins[first + i];
      join.cost =
          JoinCost((*pieces)[join.a], (*pieces)[join.b], all ? infinity : threshold, context);
    });
  };
  const double reach = kTouching * context.diagonal;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Piece& piece : *pieces) boxes.push_back(core::Bounds(piece.hull));
  for (int i = 0; i < static_cast<int>(pieces->size()); ++i) {
    for (int j = i + 1; j < static_cast<int>(pieces->size()); ++j) {
      if (boxes[i].exteriorDistance(boxes[j]) > reach) continue;
      if (Touching((*pieces)[i], (*pieces)[j], reach)) joins.push_back({i, j});
    }
  }
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
    Piece joined = Joined((*pieces)[join.a], (*pieces)[join.b], context);
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

}  // namespace simwright::geometry
