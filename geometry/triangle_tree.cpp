#include "geometry/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;

constexpr int kLeafSize = 4;
constexpr int kMaxDepth = 64;

double BoxDistanceSquared(const Vector3d& p, const Vector3d& low, const Vector3d& high) {
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
}

// Returns the ray parameter at which the ray enters the AABB, or infinity.
double BoxEntry(const Vector3d& origin, const Vector3d& inverse, const Vector3d& low,
                const Vector3d& high, double reach) {
  double enter = 0.0;
  double leave = reach;
  for (int axis = 0; axis < 3; ++axis) {
    const bool backwards = inverse[axis] < 0.0;
    const double near = ((backwards ? high : low)[axis] - origin[axis]) * inverse[axis];
    const double far = ((backwards ? low : high)[axis] - origin[axis]) * inverse[axis];
    // NaN (a ray within a slab's plane) keeps the interval unchanged.
    enter = near > enter ? near : enter;
    leave = far < leave ? far : leave;
  }
  // The margin compensates for rounding at an AABB of zero thickness.
  return enter <= leave * (1.0 + 1e-14) + 1e-300 ? enter : std::numeric_limits<double>::infinity();
}

// Intersects a ray with a triangle from either side, borders included (Moeller and Trumbore 1997).
bool HitTriangle(const Vector3d& origin, const Vector3d& direction, const Vector3d& a,
                 const Vector3d& b, const Vector3d& c, double* t) {
  const Vector3d ab = b - a;
  const Vector3d ac = c - a;
  const Vector3d p = direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0.0) return false;
  const double inverse = 1.0 / determinant;
  constexpr double kSlack = 1e-12;
  const Vector3d s = origin - a;
  const double u = s.dot(p) * inverse;
  if (!(u >= -kSlack && u <= 1.0 + kSlack)) return false;
  const Vector3d q = s.cross(ab);
  const double v = direction.dot(q) * inverse;
  if (!(v >= -kSlack && u + v <= 1.0 + kSlack)) return false;
  *t = ac.dot(q) * inverse;
  return std::isfinite(*t);
}

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

TriangleTree::TriangleTree(const core::TriangleMesh& mesh) {
  core::RequireValid(mesh, "triangle tree");
  const int count = static_cast<int>(mesh.triangles.size());
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0);
  corners_.resize(3 * static_cast<std::size_t>(count));
  for (int t = 0; t < count; ++t) {
    for (int c = 0; c < 3; ++c) {
      corners_[3 * static_cast<std::size_t>(t) + c] = mesh.vertices[mesh.triangles[t][c]];
    }
  }
  normals_.resize(count);
  for (int t = 0; t < count; ++t) normals_[t] = core::TriangleAreaVector(mesh, t).normalized();
  if (count > 0) Build();
}

Vector3d TriangleTree::Enclose(const std::vector<Vector3d>& source,
                               const std::vector<Vector3d>& centers, int first, int count,
                               Node* node) const {
  node->low.setConstant(std::numeric_limits<double>::infinity());
  node->high = -node->low;
  Vector3d center_low = node->low;
  Vector3d center_high = node->high;
  for (int i = first; i < first + count; ++i) {
    for (int c = 0; c < 3; ++c) {
      const Vector3d& p = source[3 * static_cast<std::size_t>(order_[i]) + c];
      node->low = node->low.cwiseMin(p);
      node->high = node->high.cwiseMax(p);
    }
    center_low = center_low.cwiseMin(centers[order_[i]]);
    center_high = center_high.cwiseMax(centers[order_[i]]);
  }
  return center_high - center_low;
}

void TriangleTree::Build() {
  const std::vector<Vector3d> source = corners_;
  const int count = static_cast<int>(order_.size());
  std::vector<Vector3d> centers(count);
  for (int t = 0; t < count; ++t) {
    const Vector3d* c = &source[3 * static_cast<std::size_t>(t)];
    centers[t] = 0.5 * (c[0].cwiseMin(c[1]).cwiseMin(c[2]) + c[0].cwiseMax(c[1]).cwiseMax(c[2]));
  }
  struct Task {
    int first, count, parent;  // parent: node whose right child this is, or -1
  };
  std::vector<Task> tasks{{0, count, -1}};
  nodes_.reserve(static_cast<std::size_t>(count));
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const int index = static_cast<int>(nodes_.size());
    if (task.parent >= 0) nodes_[task.parent].first = index;
    Node node;
    const Vector3d spread = Enclose(source, centers, task.first, task.count, &node);
    if (task.count <= kLeafSize) {
      node.first = task.first;
      node.count = task.count;
      nodes_.push_back(node);
      continue;
    }
    nodes_.push_back(node);
    int axis = 0;
    spread.maxCoeff(&axis);
    // The median split keeps the depth logarithmic for any input; ties go by index.
    const int half = task.count / 2;
    std::nth_element(order_.begin() + task.first, order_.begin() + task.first + half,
                     order_.begin() + task.first + task.count, [&](int a, int b) {
                       const double ca = centers[a][axis];
                       const double cb = centers[b][axis];
                       return ca < cb || (ca == cb && a < b);
                     });
    tasks.push_back({task.first + half, task.count - half, index});
    tasks.push_back({task.first, half, -1});
  }
  for (int i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) {
      corners_[3 * static_cast<std::size_t>(i) + c] =
          source[3 * static_cast<std::size_t>(order_[i]) + c];
    }
  }
}

template <typename Visit>
void TriangleTree::VisitNear(const Vector3d& p, const double& reach_squared, Visit visit) const {
  if (nodes_.empty()) return;
  std::array<std::pair<int, double>, kMaxDepth> stack;
  int top = 0;
  stack[top++] = {0, BoxDistanceSquared(p, nodes_[0].low, nodes_[0].high)};
  while (top > 0) {
    const auto [index, bound] = stack[--top];
    if (bound > reach_squared) continue;
    const Node& node = nodes_[index];
    if (node.count > 0) {
      for (int i = node.first; i < node.first + node.count; ++i) {
        const Vector3d* c = &corners_[3 * static_cast<std::size_t>(i)];
        const Vector3d q = ClosestPointOnTriangle(p, c[0], c[1], c[2]);
        if (!visit(q, (q - p).squaredNorm(), order_[i])) return;
      }
      continue;
    }
    const int left = index + 1;
    const int right = node.first;
    const double dl = BoxDistanceSquared(p, nodes_[left].low, nodes_[left].high);
    const double dr = BoxDistanceSquared(p, nodes_[right].low, nodes_[right].high);
    const bool left_first = dl <= dr;
    const std::pair<int, double> far = left_first ? std::pair{right, dr} : std::pair{left, dl};
    const std::pair<int, double> near = left_first ? std::pair{left, dl} : std::pair{right, dr};
    if (far.second <= reach_squared) stack[top++] = far;
    if (near.second <= reach_squared) stack[top++] = near;
  }
}

SurfacePoint TriangleTree::Closest(const Vector3d& p, double reach) const {
  SurfacePoint best;
  double best_squared = reach * reach;
  VisitNear(p, best_squared, [&](const Vector3d& q, double squared, int triangle) {
    if (squared < best_squared ||
        (squared == best_squared && (best.triangle < 0 || triangle < best.triangle))) {
      best_squared = squared;
      best.point = q;
      best.triangle = triangle;
    }
    return true;
  });
  if (best.triangle >= 0) best.distance = std::sqrt(best_squared);
  return best;
}

bool TriangleTree::Within(const Vector3d& p, double reach) const {
  const double reach_squared = reach * reach;
  bool within = false;
  VisitNear(p, reach_squared, [&](const Vector3d&, double squared, int) {
    within = squared <= reach_squared;
    return !within;
  });
  return within;
}

std::optional<SurfacePoint> TriangleTree::FirstHit(const Vector3d& origin,
                                                   const Vector3d& direction, double reach) const {
  if (nodes_.empty()) return std::nullopt;
  const Vector3d inverse = direction.cwiseInverse();
  SurfacePoint best;
  double limit = reach;
  std::array<std::pair<int, double>, kMaxDepth> stack;
  int top = 0;
  stack[top++] = {0, BoxEntry(origin, inverse, nodes_[0].low, nodes_[0].high, limit)};
  while (top > 0) {
    const auto [index, entry] = stack[--top];
    if (!(entry <= limit) || std::isinf(entry)) continue;
    const Node& node = nodes_[index];
    if (node.count > 0) {
      for (int i = node.first; i < node.first + node.count; ++i) {
        const Vector3d* c = &corners_[3 * static_cast<std::size_t>(i)];
        double t = 0.0;
        if (!HitTriangle(origin, direction, c[0], c[1], c[2], &t) || t < 0.0) continue;
        if (t < limit || (t == limit && (best.triangle < 0 || order_[i] < best.triangle))) {
          limit = t;
          best.triangle = order_[i];
        }
      }
      continue;
    }
    const int left = index + 1;
    const int right = node.first;
    const double dl = BoxEntry(origin, inverse, nodes_[left].low, nodes_[left].high, limit);
    const double dr = BoxEntry(origin, inverse, nodes_[right].low, nodes_[right].high, limit);
    const bool left_first = dl <= dr;
    stack[top++] = left_first ? std::pair{right, dr} : std::pair{left, dl};
    stack[top++] = left_first ? std::pair{left, dl} : std::pair{right, dr};
  }
  if (best.triangle < 0) return std::nullopt;
  best.distance = limit;
  best.point = origin + limit * direction;
  return best;
}

bool TriangleTree::SegmentMeets(const Vector3d& from, const Vector3d& to) const {
  return FirstHit(from, to - from, 1.0).has_value();
}

void TriangleTree::Overlapping(const Eigen::AlignedBox3d& box, std::vector<int>* triangles) const {
  triangles->clear();
  if (nodes_.empty()) return;
  std::array<int, kMaxDepth> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const int index = stack[--top];
    const Node& node = nodes_[index];
    if ((node.low.array() > box.max().array()).any() ||
        (node.high.array() < box.min().array()).any()) {
      continue;
    }
    if (node.count == 0) {
      stack[top++] = node.first;
      stack[top++] = index + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Vector3d* c = &corners_[3 * static_cast<std::size_t>(i)];
      const Vector3d low = c[0].cwiseMin(c[1]).cwiseMin(c[2]);
      const Vector3d high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
      if ((low.array() <= box.max().array()).all() && (high.array() >= box.min().array()).all()) {
        triangles->push_back(order_[i]);
      }
    }
  }
  std::sort(triangles->begin(), triangles->end());
}

}  // namespace simwright::geometry
