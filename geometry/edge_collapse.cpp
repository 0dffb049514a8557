#include "geometry/edge_collapse.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/progress.h"

namespace simwright::geometry {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The sum over planes of weight * (n . x - d)^2: x A x - 2 b x + c.
struct Quadric {
  Matrix3d a = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  double c = 0.0;
  double weight = 0.0;

  void AddPlane(const Vector3d& normal, double offset, double w) {
    a += w * normal * normal.transpose();
    b += w * offset * normal;
    c += w * offset * offset;
    weight += w;
  }
  Quadric& operator+=(const Quadric& other) {
    a += other.a;
    b += other.b;
    c += other.c;
    weight += other.weight;
    return *this;
  }
  double At(const Vector3d& x) const { return std::max(0.0, x.dot(a * x) - 2.0 * b.dot(x) + c); }
};

struct Candidate {
  int a, b;
  int version_a, version_b;
};

// A bucket queue of candidates by cost, an eighth of an octave per bucket, first in first out
// within one: close enough to the order of costs, and several times as fast as a heap.
class CostQueue {
 public:
  void Push(double cost, const Candidate& candidate) {
    int exponent = 0;
    const double mantissa = std::frexp(std::max(cost, 1e-60), &exponent);  // in [0.5, 1)
    const int octave = std::clamp(exponent + 200, 0, kOctaves - 1);
    const int bucket = octave * kSteps + static_cast<int>((mantissa - 0.5) * 2.0 * kSteps);
    buckets_[bucket].push_back(candidate);
    lowest_ = std::min(lowest_, bucket);
  }

  bool Pop(Candidate* candidate) {
    for (; lowest_ < kOctaves * kSteps; ++lowest_) {
      std::vector<Candidate>& bucket = buckets_[lowest_];
      std::size_t& head = heads_[lowest_];
      if (head < bucket.size()) {
        *candidate = bucket[head++];
        return true;
      }
      bucket.clear();
      head = 0;
    }
    return false;
  }

 private:
  static constexpr int kOctaves = 400;
  static constexpr int kSteps = 8;
  std::vector<std::vector<Candidate>> buckets_ =
      std::vector<std::vector<Candidate>>(kOctaves * kSteps);
  std::vector<std::size_t> heads_ = std::vector<std::size_t>(kOctaves * kSteps, 0);
  int lowest_ = kOctaves * kSteps;
};

class Collapser {
 public:
  Collapser(const core::TriangleMesh& mesh, const std::vector<char>& locked)
      : source_(mesh), vertices_(mesh.vertices), triangles_(mesh.triangles), locked_(locked) {
    // Centred coordinates: sums of squares lose digits far from the origin.
    center_ = core::Bounds(mesh).center();
    for (Vector3d& v : vertices_) v -= center_;
    around_.resize(vertices_.size());
    quadrics_.resize(vertices_.size());
    version_.assign(vertices_.size(), 0);
    mark_.assign(vertices_.size(), 0);
    alive_.assign(triangles_.size(), 1);
    live_faces_ = static_cast<int>(triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const Vector3d area = AreaVector(triangles_[t]);
      const double length = area.norm();
      for (int c = 0; c < 3; ++c) {
        const int v = triangles_[t][c];
        around_[v].push_back(static_cast<int>(t));
        if (length > 0.0) {
          const Vector3d normal = area / length;
          quadrics_[v].AddPlane(normal, normal.dot(vertices_[v]), length);
        }
      }
    }
  }

  void Run(int budget, double max_error) {
    limit_ = max_error > 0.0 ? max_error * max_error : INFINITY;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (int c = 0; c < 3; ++c) {
        const int a = triangles_[t][c];
        const int b = triangles_[t][(c + 1) % 3];
        if (a < b) Push(a, b);
      }
    }
    int collapses = 0;
    Candidate top;
    while (live_faces_ > budget && queue_.Pop(&top)) {
      if (++collapses % 4096 == 0) core::CheckCancelled();
      if (version_[top.a] != top.version_a || version_[top.b] != top.version_b) continue;
      Collapse(top.a, top.b);
    }
  }

  Thinned Result() const {
    Thinned result;
    core::TriangleMesh& mesh = result.mesh;
    std::vector<int> index(vertices_.size(), -1);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (!alive_[t]) continue;
      Eigen::Vector3i corner;
      for (int c = 0; c < 3; ++c) {
        const int v = triangles_[t][c];
        int& at = index[v];
        if (at < 0) {
          at = static_cast<int>(mesh.vertices.size());
          const bool same = version_[v] == 0;
          mesh.vertices.push_back(same ? source_.vertices[v] : vertices_[v] + center_);
          result.sources.push_back(same ? v : -1);
        }
        corner[c] = at;
      }
      mesh.triangles.push_back(corner);
    }
    return result;
  }

 private:
  Vector3d AreaVector(const Eigen::Vector3i& t) const {
    return (vertices_[t[1]] - vertices_[t[0]]).cross(vertices_[t[2]] - vertices_[t[0]]);
  }

  // Returns the minimiser of the two quadrics' sum, regularised towards the edge's midpoint where
  // they leave it free.
  Vector3d Best(int a, int b, const Quadric& sum) const {
    const Vector3d middle = 0.5 * (vertices_[a] + vertices_[b]);
    Matrix3d matrix = sum.a;
    matrix.diagonal().array() += 1e-4 * sum.weight;
    const Vector3d gradient = sum.b - sum.a * middle;
    // Cramer's rule; the regularised matrix is positive definite.
    const Vector3d yz = matrix.col(1).cross(matrix.col(2));
    const Vector3d step =
        Vector3d(gradient.dot(yz), gradient.dot(matrix.col(2).cross(matrix.col(0))),
                 gradient.dot(matrix.col(0).cross(matrix.col(1)))) /
        matrix.col(0).dot(yz);
    const double edge = (vertices_[a] - vertices_[b]).norm();
    if (!step.allFinite() || step.norm() > 2.0 * edge) return middle;
    return middle + step;
  }

  void Push(int a, int b) {
    if (locked_[a] || locked_[b]) return;
    Quadric sum = quadrics_[a];
    sum += quadrics_[b];
    const Vector3d at = Best(a, b, sum);
    const double error = sum.At(at);
    if (error > limit_ * sum.weight) return;
    // The small length term orders flat edges: short ones first.
    const double length = (vertices_[a] - vertices_[b]).squaredNorm();
    queue_.Push(error + 1e-9 * length * sum.weight, {a, b, version_[a], version_[b]});
  }

  // Returns true if the edge's ends have exactly two common neighbours and neither of these would
  // be left with two faces: the topology is then preserved.
  bool KeepsTopology(int a, int b) {
    ++stamp_;
    for (const int t : around_[a]) {
      for (int c = 0; c < 3; ++c) mark_[triangles_[t][c]] = stamp_;
    }
    int common = 0;
    common_.fill(-1);
    for (const int t : around_[b]) {
      for (int c = 0; c < 3; ++c) {
        const int v = triangles_[t][c];
        if (v == a || v == b || mark_[v] != stamp_) continue;
        if (v == common_[0] || v == common_[1]) continue;
        if (common == 2) return false;
        common_[common++] = v;
      }
    }
    return common == 2 && around_[common_[0]].size() > 3 && around_[common_[1]].size() > 3;
  }

  // Returns true if the faces at `v` but not at `other` keep their orientation and some quality
  // with v at `at`.
  bool KeepsFaces(int v, int other, const Vector3d& at) const {
    for (const int t : around_[v]) {
      const Eigen::Vector3i& corner = triangles_[t];
      if (corner[0] == other || corner[1] == other || corner[2] == other) continue;
      std::array<Vector3d, 3> p;
      for (int c = 0; c < 3; ++c) p[c] = corner[c] == v ? at : vertices_[corner[c]];
      const Vector3d before = AreaVector(corner);
      const Vector3d after = (p[1] - p[0]).cross(p[2] - p[0]);
      const double longest = std::max(
          {(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
      const double size = after.norm();
      if (!(size > 0.02 * longest)) return false;
      if (!(before.dot(after) > 0.3 * before.norm() * size)) return false;
    }
    return true;
  }

  void Collapse(int a, int b) {
    if (!KeepsTopology(a, b)) return;
    Quadric sum = quadrics_[a];
    sum += quadrics_[b];
    Vector3d at = Best(a, b, sum);
    if (!KeepsFaces(a, b, at) || !KeepsFaces(b, a, at)) {
      at = 0.5 * (vertices_[a] + vertices_[b]);
      if (sum.At(at) > limit_ * sum.weight) return;
      if (!KeepsFaces(a, b, at) || !KeepsFaces(b, a, at)) return;
    }
    vertices_[a] = at;
    quadrics_[a] = sum;
    std::vector<int> kept;
    kept.reserve(around_[a].size() + around_[b].size());
    for (const int t : around_[a]) {
      const Eigen::Vector3i& corner = triangles_[t];
      if (corner[0] != b && corner[1] != b && corner[2] != b) kept.push_back(t);
    }
    for (const int t : around_[b]) {
      Eigen::Vector3i& corner = triangles_[t];
      if (corner[0] == a || corner[1] == a || corner[2] == a) {
        alive_[t] = 0;
        --live_faces_;
        for (const int c : common_) std::erase(around_[c], t);
        continue;
      }
      for (int c = 0; c < 3; ++c) {
        if (corner[c] == b) corner[c] = a;
      }
      kept.push_back(t);
    }
    around_[a].swap(kept);
    std::vector<int>().swap(around_[b]);
    ++version_[a];
    ++version_[b];
    ++stamp_;
    for (const int t : around_[a]) {
      for (int c = 0; c < 3; ++c) {
        const int v = triangles_[t][c];
        if (v == a || mark_[v] == stamp_) continue;
        mark_[v] = stamp_;
        Push(std::min(a, v), std::max(a, v));
      }
    }
  }

  const core::TriangleMesh& source_;
  Vector3d center_;
  std::vector<Vector3d> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
  const std::vector<char>& locked_;
  std::vector<std::vector<int>> around_;
  std::vector<Quadric> quadrics_;
  std::vector<int> version_;
  std::vector<int> mark_;
  std::vector<char> alive_;
  std::array<int, 2> common_{};
  CostQueue queue_;
  double limit_ = INFINITY;
  int live_faces_ = 0;
  int stamp_ = 0;
};

}  // namespace

Thinned CollapseEdges(const core::TriangleMesh& mesh, const std::vector<char>& locked, int budget,
                      double max_error) {
  if (locked.size() != mesh.vertices.size()) {
    throw core::Error("each vertex needs a lock flag", "edge collapse");
  }
  Collapser collapser(mesh, locked);
  collapser.Run(budget, max_error);
  return collapser.Result();
}

}  // namespace simwright::geometry
