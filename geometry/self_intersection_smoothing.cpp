#include "geometry/self_intersection_smoothing.h"

#include <algorithm>
#include <vector>

#include "core/progress.h"
#include "geometry/hole_filling.h"
#include "geometry/self_intersection.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

std::vector<std::vector<int>> NeighboursOf(const core::TriangleMesh& mesh) {
  std::vector<std::vector<int>> neighbours(mesh.vertices.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) neighbours[t[k]].push_back(t[(k + 1) % 3]);
  }
  return neighbours;
}

// Returns flags for the vertices of intersecting or degenerate faces. `component`: of each face, to
// count only intersections within one; empty: all.
std::vector<char> FaultyVertices(const core::TriangleMesh& mesh,
                                 const std::vector<int>& component) {
  std::vector<char> faulty(mesh.vertices.size(), 0);
  const auto mark = [&](int triangle) {
    for (int k = 0; k < 3; ++k) faulty[mesh.triangles[triangle][k]] = 1;
  };
  for (const auto& [one, other] : SelfIntersections(mesh, 100000)) {
    if (!component.empty() && component[one] != component[other]) continue;
    mark(one);
    mark(other);
  }
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (IsDegenerate(mesh, static_cast<int>(f))) mark(static_cast<int>(f));
  }
  return faulty;
}

// The rounds of smoothing after faces were replaced, and the largest number of replacements.
constexpr int kRoundsAfter = 4, kReplacements = 3;
constexpr std::size_t kMostCorners = 120;  // of a hole that is filled
// The largest share of faulty vertices that smoothing is tried on, and that is left to be replaced.
constexpr double kMostFaulty = 0.3, kMostReplaced = 0.02;

class Smoother {
 public:
  Smoother(core::TriangleMesh* mesh, const SelfIntersectionSmoothing& options)
      : mesh_(*mesh), options_(options), original_(mesh->vertices) {}

  // Returns true if no face is faulty any more.
  bool Smooth(int rounds);
  // Replaces the faulty faces and `rings` rings of faces around them. Returns false if a hole
  // cannot be filled; the mesh is then unchanged.
  bool Replace(int rings);
  bool MayReplace() const { return options_.replaces_faces && faulty_share_ < kMostReplaced; }

 private:
  std::vector<char> Faulty() const {
    int count = 0;
    return FaultyVertices(
        mesh_, options_.within_components ? EdgeComponents(mesh_, &count) : std::vector<int>());
  }
  void MoveToNeighbours(const std::vector<char>& moving,
                        const std::vector<std::vector<int>>& neighbours);

  core::TriangleMesh& mesh_;
  const SelfIntersectionSmoothing& options_;
  const std::vector<Eigen::Vector3d> original_;
  double faulty_share_ = 0.0;  // of the vertices, when Smooth returned
};

void Smoother::MoveToNeighbours(const std::vector<char>& moving,
                                const std::vector<std::vector<int>>& neighbours) {
  const std::vector<Eigen::Vector3d> before = mesh_.vertices;
  for (std::size_t v = 0; v < moving.size(); ++v) {
    if (!moving[v] || neighbours[v].empty()) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int n : neighbours[v]) mean += before[n];
    mesh_.vertices[v] = 0.5 * before[v] + 0.5 * mean / static_cast<double>(neighbours[v].size());
    const Eigen::Vector3d move = mesh_.vertices[v] - original_[v];
    if (options_.max_move > 0.0 && move.norm() > options_.max_move) {
      mesh_.vertices[v] = original_[v] + options_.max_move * move.normalized();
    }
  }
}

bool Smoother::Smooth(int rounds) {
  const bool limited = options_.replaces_faces;
  const std::vector<std::vector<int>> neighbours = NeighboursOf(mesh_);
  for (int round = 0;; ++round) {
    core::CheckCancelled();
    std::vector<char> moving = Faulty();
    const auto count = std::count(moving.begin(), moving.end(), 1);
    if (count == 0) return true;
    faulty_share_ = static_cast<double>(count) / static_cast<double>(moving.size());
    if (round == rounds || (limited && faulty_share_ > kMostFaulty)) return false;
    for (int ring = 0; ring < 1 + round / 3; ++ring) {
      std::vector<char> wider = moving;
      for (std::size_t v = 0; v < moving.size(); ++v) {
        if (!moving[v]) continue;
        for (const int n : neighbours[v]) wider[n] = 1;
      }
      moving = wider;
    }
    for (int pass = 0; pass < 3; ++pass) MoveToNeighbours(moving, neighbours);
  }
}

bool Smoother::Replace(int rings) {
  std::vector<char> marked = Faulty();
  std::vector<char> gone(mesh_.triangles.size(), 0);
  for (int ring = 0; ring < rings; ++ring) {
    for (std::size_t t = 0; t < gone.size(); ++t) {
      for (const int v : mesh_.triangles[t]) gone[t] |= marked[v];
    }
    for (std::size_t t = 0; t < gone.size(); ++t) {
      for (const int v : mesh_.triangles[t]) marked[v] |= gone[t];
    }
  }
  core::TriangleMesh rest;
  rest.vertices = mesh_.vertices;
  for (std::size_t t = 0; t < gone.size(); ++t) {
    if (!gone[t]) rest.triangles.push_back(mesh_.triangles[t]);
  }
  std::vector<Eigen::Vector3i> patches;
  for (const BoundaryLoop& loop : BoundaryLoops(rest)) {
    if (loop.size() > kMostCorners) return false;
    const std::vector<Eigen::Vector3i> patch = FillLoop(rest.vertices, loop);
    if (patch.empty()) return false;
    patches.insert(patches.end(), patch.begin(), patch.end());
  }
  rest.triangles.insert(rest.triangles.end(), patches.begin(), patches.end());
  mesh_.triangles.swap(rest.triangles);
  return true;
}

}  // namespace

bool SmoothSelfIntersections(core::TriangleMesh* mesh, const SelfIntersectionSmoothing& options) {
  Smoother smoother(mesh, options);
  if (smoother.Smooth(options.rounds)) return true;
  for (int i = 1; i <= kReplacements && smoother.MayReplace(); ++i) {
    if (smoother.Replace(i) && smoother.Smooth(kRoundsAfter)) return true;
  }
  return false;
}

}  // namespace simwright::geometry
