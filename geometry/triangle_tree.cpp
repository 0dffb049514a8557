#include "geometry/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "geometry/triangle_lanes.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr int kWidth = core::kLanes;    // children of a node, triangles of a leaf
constexpr int kDeepest = 64;            // entries of a stack: three for each of at most 16 levels
constexpr double kBoxRounding = 1e-12;  // of the largest coordinate

// A node or leaf (TriangleTree::Node::child) that waits for its visit, and its bound.
struct Waiting {
  int child;
  double bound;
};

// The children of one node that wait, the nearest last.
class Queue {
 public:
  void Push(int child, double bound) {
    int at = size_++;
    for (; at > from_ && entries_[at - 1].bound < bound; --at) entries_[at] = entries_[at - 1];
    entries_[at] = {child, bound};
  }
  // Starts the children of another node, which are visited before all that wait.
  void Open() { from_ = size_; }
  bool empty() const { return size_ == 0; }
  const Waiting& Pop() { return entries_[--size_]; }

 private:
  std::array<Waiting, kDeepest> entries_;
  int size_ = 0, from_ = 0;
};

// The triangles of a mesh, in an order that construction changes, with the middles of their AABBs.
class Splitting {
 public:
  struct Range {
    int first, count;
  };

  explicit Splitting(const core::TriangleMesh& mesh)
      : mesh_(mesh), order_(mesh.triangles.size()), middles_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    for (std::size_t t = 0; t < middles_.size(); ++t) {
      const Eigen::AlignedBox3d box = BoxOf(static_cast<int>(t));
      middles_[t] = 0.5 * (box.min() + box.max());
    }
  }

  int At(int place) const { return order_[place]; }

  Eigen::AlignedBox3d BoxOf(const Range& range) const {
    Eigen::AlignedBox3d box;
    for (int i = range.first; i < range.first + range.count; ++i) box.extend(BoxOf(order_[i]));
    return box;
  }

  // Returns up to four parts of a range, halved at the medians of the middles: the depth is
  // logarithmic for any input. Halves are multiples of a leaf's size, so that few leaves have gaps.
  std::vector<Range> Parts(const Range& whole) {
    std::vector<Range> parts{whole};
    while (parts.size() < kWidth) {
      const auto largest =
          std::max_element(parts.begin(), parts.end(),
                           [](const Range& a, const Range& b) { return a.count < b.count; });
      if (largest->count <= kWidth) break;
      const Range range = *largest;
      const int half = (range.count / 2 + kWidth - 1) / kWidth * kWidth;
      Halve(range, half);
      *largest = {range.first, half};
      parts.insert(largest + 1, {range.first + half, range.count - half});
    }
    return parts;
  }

 private:
  Eigen::AlignedBox3d BoxOf(int triangle) const {
    Eigen::AlignedBox3d box;
    for (int k = 0; k < 3; ++k) box.extend(mesh_.vertices[mesh_.triangles[triangle][k]]);
    return box;
  }

  // Moves the `half` triangles that are lower along the longest extent to the front; ties go by
  // number.
  void Halve(const Range& range, int half) {
    Eigen::AlignedBox3d spread;
    for (int i = range.first; i < range.first + range.count; ++i) {
      spread.extend(middles_[order_[i]]);
    }
    int axis = 0;
    spread.sizes().maxCoeff(&axis);
    std::nth_element(order_.begin() + range.first, order_.begin() + range.first + half,
                     order_.begin() + range.first + range.count, [&](int a, int b) {
                       const double at_a = middles_[a][axis], at_b = middles_[b][axis];
                       return at_a < at_b || (at_a == at_b && a < b);
                     });
  }

  const core::TriangleMesh& mesh_;
  std::vector<int> order_;
  std::vector<Vector3d> middles_;
};

}  // namespace

Vector3d ClosestPointOnTriangle(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                                const Vector3d& c) {
  const Vector3d ab = b - a;
  const Vector3d ac = c - a;
  const Vector3d ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const Vector3d bp = p - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + (d1 / (d1 - d3)) * ab;
  const Vector3d cp = p - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  }
  const double sum = va + vb + vc;
  if (!(sum > 0.0)) return a;
  return a + (vb / sum) * ab + (vc / sum) * ac;
}

namespace {

// Visits leaves that may be within reach, nearer AABBs first: visit(leaf, squared distances of its
// triangles), until it returns false. The visitor may shorten the reach.
template <typename Visit>
__attribute__((always_inline)) inline void VisitNear(const std::vector<TreeNode>& nodes,
                                                     const std::vector<TreeLeaf>& leaves,
                                                     const Vector3d& p, const double& reach_squared,
                                                     Visit visit) {
  if (nodes.empty()) return;
  Queue queue;
  queue.Push(0, 0.0);
  double squared[kWidth];
  while (!queue.empty()) {
    const auto [child, bound] = queue.Pop();
    if (bound > reach_squared) continue;
    if (child < 0) {
      const TreeLeaf& leaf = leaves[~child];
      SquaredDistances(leaf.triangles, p, squared);
      if (!visit(leaf, squared)) return;
      continue;
    }
    const TreeNode& node = nodes[child];
    SquaredDistances(node.boxes, p, squared);
    queue.Open();
    for (int i = 0; i < node.count; ++i) {
      if (squared[i] <= reach_squared) queue.Push(node.child[i], squared[i]);
    }
  }
}

SIMWRIGHT_WIDEST_VECTORS SurfacePoint ClosestPoint(const std::vector<TreeNode>& nodes,
                                                   const std::vector<TreeLeaf>& leaves,
                                                   const Vector3d& p, double reach) {
  SurfacePoint best;
  double best_squared = reach * reach;
  const TreeLeaf* home = nullptr;
  int place = 0;
  const auto take = [&](const TreeLeaf& leaf, const double* squared)
      __attribute__((always_inline)) {
    for (int i = 0; i < kWidth; ++i) {
      if (squared[i] < best_squared ||
          (squared[i] == best_squared && (best.triangle < 0 || leaf.index[i] < best.triangle))) {
        best_squared = squared[i];
        best.triangle = leaf.index[i];
        home = &leaf;
        place = i;
      }
    }
    return true;
  };
  VisitNear(nodes, leaves, p, best_squared, take);
  if (!home) return best;
  const auto corner = [&](const double(&rows)[3][kWidth]) {
    return Vector3d(rows[0][place], rows[1][place], rows[2][place]);
  };
  const TriangleLanes& triangles = home->triangles;
  best.point =
      ClosestPointOnTriangle(p, corner(triangles.a), corner(triangles.b), corner(triangles.c));
  best.distance = std::sqrt(best_squared);
  return best;
}

SIMWRIGHT_WIDEST_VECTORS bool IsWithin(const std::vector<TreeNode>& nodes,
                                       const std::vector<TreeLeaf>& leaves, const Vector3d& p,
                                       double reach, int* home) {
  const double reach_squared = reach * reach;
  bool within = false;
  const auto test = [&](const TreeLeaf& leaf, const double* squared)
      __attribute__((always_inline)) {
    for (int i = 0; i < kWidth; ++i) within |= squared[i] <= reach_squared;
    if (within) *home = static_cast<int>(&leaf - leaves.data());
    return !within;
  };
  if (*home >= 0) {
    double squared[kWidth];
    SquaredDistances(leaves[*home].triangles, p, squared);
    if (!test(leaves[*home], squared)) return true;
  }
  VisitNear(nodes, leaves, p, reach_squared, test);
  return within;
}

// Returns triangle -1 if nothing is hit.
SIMWRIGHT_WIDEST_VECTORS SurfacePoint NearestHit(const std::vector<TreeNode>& nodes,
                                                 const std::vector<TreeLeaf>& leaves,
                                                 const Vector3d& origin, const Vector3d& direction,
                                                 double reach) {
  SurfacePoint best;
  if (nodes.empty()) return best;
  const Vector3d inverse = direction.cwiseInverse();
  double limit = reach;
  double at[kWidth];
  Queue queue;
  queue.Push(0, 0.0);
  while (!queue.empty()) {
    const auto [child, entry] = queue.Pop();
    if (entry > limit) continue;
    if (child < 0) {
      const TreeLeaf& leaf = leaves[~child];
      Hits(leaf.triangles, origin, direction, at);
      for (int i = 0; i < kWidth; ++i) {
        if (std::isinf(at[i])) continue;
        if (at[i] < limit ||
            (at[i] == limit && (best.triangle < 0 || leaf.index[i] < best.triangle))) {
          limit = at[i];
          best.triangle = leaf.index[i];
        }
      }
      continue;
    }
    const TreeNode& node = nodes[child];
    Entries(node.boxes, origin, inverse, limit, at);
    queue.Open();
    for (int i = 0; i < node.count; ++i) {
      if (!std::isinf(at[i])) queue.Push(node.child[i], at[i]);
    }
  }
  if (best.triangle < 0) return best;
  best.distance = limit;
  best.point = origin + limit * direction;
  return best;
}

}  // namespace

TriangleTree::TriangleTree(const core::TriangleMesh& mesh) {
  core::RequireValid(mesh, "triangle tree");
  const int count = static_cast<int>(mesh.triangles.size());
  normals_.resize(count);
  for (int t = 0; t < count; ++t) normals_[t] = core::TriangleAreaVector(mesh, t).normalized();
  if (count > 0) Build(mesh);
}

void TriangleTree::Build(const core::TriangleMesh& mesh) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Splitting splitting(mesh);
  const Eigen::AlignedBox3d bounds = core::Bounds(mesh);
  const double rounding = kBoxRounding * std::max(bounds.min().cwiseAbs().maxCoeff(),
                                                  bounds.max().cwiseAbs().maxCoeff());
  const auto add_leaf = [&](const Splitting::Range& range) {
    TreeLeaf leaf;
    for (int i = 0; i < kWidth; ++i) {
      leaf.index[i] = i < range.count ? splitting.At(range.first + i) : -1;
      for (int k = 0; k < 3; ++k) {
        const auto at = [&](int corner) {
          return i < range.count ? mesh.vertices[mesh.triangles[leaf.index[i]][corner]][k] : nan;
        };
        leaf.triangles.a[k][i] = at(0);
        leaf.triangles.b[k][i] = at(1);
        leaf.triangles.c[k][i] = at(2);
      }
    }
    leaves_.push_back(leaf);
    return static_cast<int>(leaves_.size()) - 1;
  };
  struct Task {
    Splitting::Range range;
    int parent, child;
  };
  std::vector<Task> tasks{{{0, size()}, -1, 0}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const int index = static_cast<int>(nodes_.size());
    if (task.parent >= 0) nodes_[task.parent].child[task.child] = index;
    TreeNode node;
    for (const Splitting::Range& range : splitting.Parts(task.range)) {
      const Eigen::AlignedBox3d box = splitting.BoxOf(range);
      for (int k = 0; k < 3; ++k) {
        node.boxes.low[k][node.count] = box.min()[k] - rounding;
        node.boxes.high[k][node.count] = box.max()[k] + rounding;
      }
      if (range.count <= kWidth) {
        node.child[node.count] = ~add_leaf(range);
      } else {
        tasks.push_back({range, index, node.count});
      }
      ++node.count;
    }
    for (int i = node.count; i < kWidth; ++i) {
      for (int k = 0; k < 3; ++k) node.boxes.low[k][i] = node.boxes.high[k][i] = nan;
    }
    nodes_.push_back(node);
  }
}

SurfacePoint TriangleTree::Closest(const Vector3d& p, double reach) const {
  return ClosestPoint(nodes_, leaves_, p, reach);
}

bool TriangleTree::Within(const Vector3d& p, double reach) const {
  int home = -1;
  return Within(p, reach, &home);
}

bool TriangleTree::Within(const Vector3d& p, double reach, int* home) const {
  return IsWithin(nodes_, leaves_, p, reach, home);
}

std::optional<SurfacePoint> TriangleTree::FirstHit(const Vector3d& origin,
                                                   const Vector3d& direction, double reach) const {
  const SurfacePoint hit = NearestHit(nodes_, leaves_, origin, direction, reach);
  if (hit.triangle < 0) return std::nullopt;
  return hit;
}

bool TriangleTree::SegmentMeets(const Vector3d& from, const Vector3d& to) const {
  return FirstHit(from, to - from, 1.0).has_value();
}

void TriangleTree::Overlapping(const Eigen::AlignedBox3d& box, std::vector<int>* triangles) const {
  triangles->clear();
  if (nodes_.empty()) return;
  std::array<int, kDeepest> waiting;
  int top = 0;
  waiting[top++] = 0;
  while (top > 0) {
    const int child = waiting[--top];
    if (child < 0) {
      const TreeLeaf& leaf = leaves_[~child];
      for (int i = 0; i < kWidth && leaf.index[i] >= 0; ++i) {
        bool overlaps = true;
        for (int k = 0; k < 3; ++k) {
          const auto [low, high] =
              std::minmax({leaf.triangles.a[k][i], leaf.triangles.b[k][i], leaf.triangles.c[k][i]});
          overlaps = overlaps && low <= box.max()[k] && high >= box.min()[k];
        }
        if (overlaps) triangles->push_back(leaf.index[i]);
      }
      continue;
    }
    const TreeNode& node = nodes_[child];
    for (int i = 0; i < node.count; ++i) {
      bool overlaps = true;
      for (int k = 0; k < 3; ++k) {
        overlaps = overlaps && node.boxes.low[k][i] <= box.max()[k] &&
                   node.boxes.high[k][i] >= box.min()[k];
      }
      if (overlaps) waiting[top++] = node.child[i];
    }
  }
  std::sort(triangles->begin(), triangles->end());
}

}  // namespace simwright::geometry
