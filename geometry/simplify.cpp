#include "geometry/simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "geometry/self_intersection.h"
#include "geometry/soundness.h"

namespace simwright::geometry {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Sum over planes of weight * (n . x - d)^2: x A x - 2 b x + c.
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

// Candidates by cost, an eighth of an octave a bucket, first in first out within one: near enough
// to the order of costs, and several times as fast as a heap.
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

// A mesh made from another one, and for each vertex the other's that it still is, or -1.
struct Thinned {
  core::TriangleMesh mesh;
  std::vector<int> sources;
};

class Collapser {
 public:
  Collapser(const core::TriangleMesh& mesh, const std::vector<char>& locked)
      : source_(mesh), vertices_(mesh.vertices), triangles_(mesh.triangles), locked_(locked) {
    // Sums of squares lose digits far from the origin.
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

  // Where the two planes' sums are least; held near the middle where they leave it free.
  Vector3d Best(int a, int b, const Quadric& sum) const {
    const Vector3d middle = 0.5 * (vertices_[a] + vertices_[b]);
    Matrix3d matrix = sum.a;
    matrix.diagonal().array() += 1e-4 * sum.weight;
    const Vector3d gradient = sum.b - sum.a * middle;
    // Cramer's rule; the held matrix is positive definite.
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
    // The little added length sorts what is flat: short edges first.
    const double length = (vertices_[a] - vertices_[b]).squaredNorm();
    queue_.Push(error + 1e-9 * length * sum.weight, {a, b, version_[a], version_[b]});
  }

  // Exactly two common neighbours, neither left with two faces: the topology stays.
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

  // Whether the faces at `v` but not at `other` keep their side and some shape with v at `at`.
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

// Vertices of `source` near where faces of `result` cross stay put in the next try.
void LockAround(const core::TriangleMesh& source, const core::TriangleMesh& result,
                const std::vector<std::pair<int, int>>& pairs, double reach,
                std::vector<char>* locked) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const auto& [s, t] : pairs) {
    Eigen::AlignedBox3d first, second;
    for (int c = 0; c < 3; ++c) {
      first.extend(result.vertices[result.triangles[s][c]]);
      second.extend(result.vertices[result.triangles[t][c]]);
    }
    Eigen::AlignedBox3d box = first.intersection(second);
    if (box.isEmpty()) box = first;
    boxes.emplace_back(box.min() - Vector3d::Constant(reach),
                       box.max() + Vector3d::Constant(reach));
  }
  std::sort(boxes.begin(), boxes.end(),
            [](const auto& a, const auto& b) { return a.min().x() < b.min().x(); });
  for (std::size_t v = 0; v < source.vertices.size(); ++v) {
    if ((*locked)[v]) continue;
    for (const auto& box : boxes) {
      if (box.min().x() > source.vertices[v].x()) break;
      if (box.contains(source.vertices[v])) {
        (*locked)[v] = 1;
        break;
      }
    }
  }
}

constexpr int kTries = 8;
constexpr int kPairLimit = 5000;

Thinned AsItWas(const core::TriangleMesh& source) {
  Thinned same{source, std::vector<int>(source.vertices.size())};
  std::iota(same.sources.begin(), same.sources.end(), 0);
  return same;
}

// One descent to `budget`, tried again with more vertices held until nothing crosses.
Thinned Descend(const core::TriangleMesh& source, int budget, double max_error,
                std::vector<char> locked) {
  double edge = 0.0;
  for (const Eigen::Vector3i& t : source.triangles) {
    edge += (source.vertices[t[0]] - source.vertices[t[1]]).norm();
  }
  double reach = 2.0 * edge / static_cast<double>(source.triangles.size());
  for (int tries = 0; tries < kTries; ++tries, reach *= 1.6) {
    Collapser collapser(source, locked);
    collapser.Run(budget, max_error);
    Thinned result = collapser.Result();
    const auto pairs = SelfIntersections(result.mesh, kPairLimit);
    bool degenerate = false;
    for (int t = 0; t < static_cast<int>(result.mesh.triangles.size()) && !degenerate; ++t) {
      degenerate = IsDegenerate(result.mesh, t);
    }
    if (pairs.empty() && !degenerate) return result;
    if (degenerate) break;
    LockAround(source, result.mesh, pairs, reach, &locked);
  }
  return AsItWas(source);
}

constexpr int kBlockFaces = 40000;  // what a core's cache holds with its quadrics

// Faces in blocks that lie together: along a space-filling curve (Morton) over their centres.
std::vector<std::vector<int>> Blocks(const core::TriangleMesh& mesh) {
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

// A mesh in blocks of faces that are thinned apart from each other.
class BlockThinner {
 public:
  explicit BlockThinner(const core::TriangleMesh& mesh)
      : mesh_(mesh), blocks_(Blocks(mesh)), owner_(mesh.vertices.size(), kNobody) {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      for (const int t : blocks_[b]) {
        for (int c = 0; c < 3; ++c) {
          int& owner = owner_[mesh.triangles[t][c]];
          owner = owner == kNobody || owner == static_cast<int>(b) ? static_cast<int>(b) : kShared;
        }
      }
    }
  }

  // Thins what is nearly flat; the blocks' common vertices stay. Where faces of two blocks come to
  // cross, both blocks are left as they were.
  core::TriangleMesh Run(double max_error) {
    std::vector<Thinned> thinned(blocks_.size());
    core::ParallelFor(static_cast<int>(blocks_.size()),
                      [&](int b) { thinned[b] = Thin(b, max_error); });
    for (int tries = 0; tries < kTries; ++tries) {
      std::vector<int> block;  // of each face
      core::TriangleMesh joined = Join(thinned, &block);
      const auto pairs = SelfIntersections(joined, kPairLimit);
      if (pairs.empty()) return joined;
      for (const auto& [s, t] : pairs) {
        for (const int b : {block[s], block[t]}) thinned[b] = Thin(b, 0.0);
      }
    }
    return mesh_;
  }

 private:
  static constexpr int kNobody = -1;
  static constexpr int kShared = -2;

  // Error 0: the block as it was.
  Thinned Thin(int b, double max_error) const {
    core::TriangleMesh part;
    std::vector<char> locked;
    std::vector<int> original;
    std::unordered_map<int, int> index;
    for (const int t : blocks_[b]) {
      Eigen::Vector3i corner;
      for (int c = 0; c < 3; ++c) {
        const int v = mesh_.triangles[t][c];
        const auto [entry, fresh] = index.try_emplace(v, static_cast<int>(part.vertices.size()));
        corner[c] = entry->second;
        if (!fresh) continue;
        part.vertices.push_back(mesh_.vertices[v]);
        locked.push_back(owner_[v] == kShared);
        original.push_back(v);
      }
      part.triangles.push_back(corner);
    }
    Thinned thinned = max_error > 0.0 ? Descend(part, 0, max_error, locked) : AsItWas(part);
    for (int& s : thinned.sources) s = s < 0 ? -1 : original[s];
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
  std::vector<int> owner_;  // of each vertex: its block, or kShared
};

}  // namespace

core::TriangleMesh Simplify(const core::TriangleMesh& mesh, const SimplifyOptions& options) {
  const Soundness state = Examine(mesh, 0);
  if (mesh.empty() || !state.closed || !state.manifold) {
    throw core::Error("only a closed, manifold mesh can be simplified", "simplify",
                      "make a solid of it first");
  }
  core::TriangleMesh result = mesh;
  if (options.max_error > 0.0 && static_cast<int>(mesh.triangles.size()) > 2 * kBlockFaces) {
    result = BlockThinner(mesh).Run(0.15 * options.max_error);
  }
  // In steps: one that has to be tried again is then a cheap one. The first takes what is nearly
  // flat, which hardly ever makes faces cross.
  const int halfway = std::max(4 * options.face_budget, 4);
  const int budget = std::max(options.face_budget, 4);
  const double error = options.max_error;
  const std::array<std::pair<int, double>, 3> steps = {
      std::pair{halfway, 0.15 * error}, std::pair{halfway, error}, std::pair{budget, error}};
  for (const auto& [faces, limit] : steps) {
    if (static_cast<int>(result.triangles.size()) <= faces) continue;
    result = Descend(result, faces, limit, std::vector<char>(result.vertices.size(), 0)).mesh;
  }
  return result;
}

}  // namespace simwright::geometry
