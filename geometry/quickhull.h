#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::geometry {

// The incremental Quickhull algorithm with a list of outside points per face (Barber, Dobkin and
// Huhdanpaa, "The quickhull algorithm for convex hulls", 1996). Among points equally far above a
// face, the one farthest from the centroid is taken: the maximum of a strictly convex function over
// a convex set is at one of its corners, so no vertex lies inside an edge or a facet of the hull.
class Quickhull {
  using Vector3d = Eigen::Vector3d;

  static constexpr double kFlatPoints = 1e-6;  // of the diagonal: a set this thin is flat
  static constexpr double kTie = 1e-10;        // of the diagonal: points equally far above a face
  static constexpr double kThin = 1e-3;        // of the diagonal: a face whose plane may be
                                               // inaccurate
  static constexpr double kNone = -1.0;        // height of a face without points outside
  static constexpr double kThinnest = 1e-8;    // of the diagonal: smallest height of a triangle

 public:
  Quickhull(const std::vector<Vector3d>& points, double diagonal, double tolerance)
      : points_(points), diagonal_(diagonal), tolerance_(tolerance), next_(points.size(), -1) {
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& p : points_) sum += p;
    middle_ = sum / static_cast<double>(points_.size());
  }

  // Returns false if the points are flat.
  bool Start() {
    std::array<int, 4> corner;
    if (!FirstTetrahedron(&corner)) return false;
    const Vector3d& a = points_[corner[0]];
    if ((points_[corner[1]] - a).cross(points_[corner[2]] - a).dot(points_[corner[3]] - a) > 0.0) {
      std::swap(corner[0], corner[1]);
    }
    // With a, b, c counter-clockwise seen from outside, d lies below.
    static constexpr int kFaces[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    static constexpr int kNeighbours[4][3] = {{1, 2, 3}, {3, 2, 0}, {1, 3, 0}, {2, 1, 0}};
    for (int f = 0; f < 4; ++f) {
      const int face = NewFace(corner[kFaces[f][0]], corner[kFaces[f][1]], corner[kFaces[f][2]]);
      for (int k = 0; k < 3; ++k) faces_[face].neighbour[k] = kNeighbours[f][k];
    }
    used_ = 4;
    for (const int c : corner) inside_ += 0.25 * points_[c];
    std::vector<int> all;
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
      if (std::find(corner.begin(), corner.end(), i) == corner.end()) all.push_back(i);
    }
    const std::vector<int> start{0, 1, 2, 3};
    Distribute(all, start);
    return true;
  }

  void Grow(int max_vertices) {
    while (max_vertices == 0 || used_ < max_vertices) {
      const int face = max_vertices == 0 ? AnyFaceWithPoints() : FarthestFace();
      if (face < 0) return;
      Add(face);
    }
  }

  core::TriangleMesh Take() const {
    core::TriangleMesh hull;
    std::vector<int> index(points_.size(), -1);
    for (const Face& face : faces_) {
      if (!face.alive) continue;
      Eigen::Vector3i triangle;
      for (int k = 0; k < 3; ++k) {
        int& to = index[face.vertex[k]];
        if (to < 0) {
          to = static_cast<int>(hull.vertices.size());
          hull.vertices.push_back(points_[face.vertex[k]]);
        }
        triangle[k] = to;
      }
      hull.triangles.push_back(triangle);
    }
    return hull;
  }

  enum class Verdict { kSound, kNeedle, kFolded };

  // Checks that no triangle is a needle or inverted and that no two neighbours fold inward by more
  // than the tolerance. `needle` receives the middle point of a faulty thin triangle.
  Verdict Judge(int* needle) const {
    if (skipped_ > 4 * tolerance_) return Verdict::kFolded;
    bool folded = false;
    for (const Face& face : faces_) {
      if (!face.alive) continue;
      int apex = 0;
      const double height = face.twice_area / LongestEdge(face, &apex);
      bool good = height > kThinnest * diagonal_ && face.Height(inside_) < -tolerance_;
      // A thin face's plane says little about its neighbourhood: test it against all corners.
      if (height < kThin * diagonal_) {
        if (!good || !Supports(face)) {
          *needle = face.vertex[apex];
          return Verdict::kNeedle;
        }
        continue;
      }
      for (int k = 0; k < 3; ++k) {
        good = good && face.Height(points_[Opposite(face, k)]) <= 8 * tolerance_;
      }
      folded = folded || !good;
    }
    return folded ? Verdict::kFolded : Verdict::kSound;
  }

 private:
  struct Face {
    std::array<int, 3> vertex;
    std::array<int, 3> neighbour;  // across the edge vertex[k] -> vertex[k + 1]
    Vector3d normal;
    double offset = 0.0;
    double twice_area = 0.0;
    bool alive = true;
    int visited = 0;
    int farthest = -1;
    double farthest_height = 0.0;
    int first = -1, last = -1;  // of the list of points outside of it (next_); -1: none

    double Height(const Vector3d& p) const { return normal.dot(p) - offset; }
  };

  struct HorizonEdge {
    int from, to, face, edge;  // `face` stays, `edge` is its side towards the visible faces
  };

  // Returns the length of the longest edge; `apex` receives the corner opposite to it.
  double LongestEdge(const Face& face, int* apex) const {
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double length =
          (points_[face.vertex[(k + 1) % 3]] - points_[face.vertex[(k + 2) % 3]]).norm();
      if (length <= longest) continue;
      longest = length;
      *apex = k;
    }
    return longest;
  }

  // Returns the corner of the neighbour across the edge `k` that is not on it.
  int Opposite(const Face& face, int k) const {
    const Face& other = faces_[face.neighbour[k]];
    int at = 0;
    while (other.vertex[at] == face.vertex[k] || other.vertex[at] == face.vertex[(k + 1) % 3]) ++at;
    return other.vertex[at];
  }

  // Returns true if no corner of the hull is above the face.
  bool Supports(const Face& face) const {
    for (const Face& other : faces_) {
      if (!other.alive) continue;
      for (const int v : other.vertex) {
        if (face.Height(points_[v]) > 8 * tolerance_) return false;
      }
    }
    return true;
  }

  bool FirstTetrahedron(std::array<int, 4>* corner) const {
    const int n = static_cast<int>(points_.size());
    const auto argmax = [&](auto value) {
      int best = 0;
      double highest = -1.0;
      for (int i = 0; i < n; ++i) {
        const double v = value(points_[i]);
        if (v > highest) {
          highest = v;
          best = i;
        }
      }
      return best;
    };
    const int a = argmax([&](const Vector3d& p) { return (p - middle_).squaredNorm(); });
    const int b = argmax([&](const Vector3d& p) { return (p - points_[a]).squaredNorm(); });
    const Vector3d along = (points_[b] - points_[a]).normalized();
    const int c = argmax([&](const Vector3d& p) {
      return (p - points_[a] - along * along.dot(p - points_[a])).squaredNorm();
    });
    Vector3d normal = along.cross(points_[c] - points_[a]);
    if (normal.norm() < kFlatPoints * diagonal_) return false;
    normal.normalize();
    // Among all equally far points, take the one farthest from the centroid: a true corner.
    const auto height = [&](const Vector3d& p) { return std::abs(normal.dot(p - points_[a])); };
    const double top = height(points_[argmax(height)]);
    if (top < kFlatPoints * diagonal_) return false;
    const int d = argmax([&](const Vector3d& p) {
      return height(p) >= top - kTie * diagonal_ ? (p - middle_).squaredNorm() : -1.0;
    });
    *corner = {a, b, c, d};
    return true;
  }

  int NewFace(int a, int b, int c) {
    int index;
    if (free_.empty()) {
      index = static_cast<int>(faces_.size());
      faces_.emplace_back();
      height_.push_back(kNone);
    } else {
      index = free_.back();
      free_.pop_back();
    }
    Face& face = faces_[index];
    face.vertex = {a, b, c};
    const Vector3d area = (points_[b] - points_[a]).cross(points_[c] - points_[a]);
    face.twice_area = area.norm();
    face.normal = face.twice_area > 0.0 ? Vector3d(area / face.twice_area) : Vector3d::Zero();
    face.offset = face.normal.dot(points_[a] + points_[b] + points_[c]) / 3.0;
    face.alive = true;
    face.visited = 0;
    Empty(index);
    return index;
  }

  // Forgets the points outside of a face.
  void Empty(int index) {
    Face& face = faces_[index];
    face.farthest = face.first = face.last = -1;
    face.farthest_height = 0.0;
    height_[index] = kNone;
  }

  // Appends a face's points to `points`, except for `left_out`.
  void AppendOutside(const Face& face, int left_out, std::vector<int>* points) const {
    for (int p = face.first; p >= 0; p = next_[p]) {
      if (p != left_out) points->push_back(p);
    }
  }

  // Assigns each point to the face that it is farthest above; points inside all faces are dropped.
  void Distribute(const std::vector<int>& candidates, const std::vector<int>& faces);

  // Adds a point to those outside of a face.
  void Assign(int p, int index, double height) {
    Face& face = faces_[index];
    (face.last < 0 ? face.first : next_[face.last]) = p;
    face.last = p;
    next_[p] = -1;
    const double tie = kTie * diagonal_;
    const bool farther = height > face.farthest_height + tie;
    const bool same = !farther && height > face.farthest_height - tie;
    if (face.farthest < 0 || farther ||
        (same &&
         (points_[p] - middle_).squaredNorm() > (points_[face.farthest] - middle_).squaredNorm())) {
      face.farthest = p;
      face.farthest_height = std::max(face.farthest_height, height);
      height_[index] = face.farthest_height;
    }
  }

  int AnyFaceWithPoints() {
    while (!pending_.empty()) {
      const int f = pending_.back();
      pending_.pop_back();
      if (faces_[f].alive && faces_[f].first >= 0) return f;
    }
    return -1;
  }

  int FarthestFace() const {
    const auto best = std::max_element(height_.begin(), height_.end());
    return *best == kNone ? -1 : static_cast<int>(best - height_.begin());
  }

  // Collects into seen_ the faces visible from `p` and connected to `face`, and into horizon_ their
  // border.
  void Look(int face, const Vector3d& p) {
    seen_.assign(1, face);
    horizon_.clear();
    ++visit_;
    faces_[face].visited = visit_;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const int n = faces_[seen_[i]].neighbour[k];
        if (faces_[n].visited == visit_) continue;
        if (faces_[n].Height(p) > tolerance_) {
          faces_[n].visited = visit_;
          seen_.push_back(n);
        }
      }
    }
    for (const int f : seen_) {
      for (int k = 0; k < 3; ++k) {
        const int n = faces_[f].neighbour[k];
        if (faces_[n].visited == visit_) continue;
        const int from = faces_[f].vertex[k];
        const int to = faces_[f].vertex[(k + 1) % 3];
        int edge = 0;
        while (faces_[n].vertex[edge] != to) ++edge;
        horizon_.push_back({from, to, n, edge});
      }
    }
  }

  // Orders the horizon; returns false if it is not one simple loop.
  bool OrderHorizon() {
    for (std::size_t i = 0; i + 1 < horizon_.size(); ++i) {
      std::size_t next = i + 1;
      while (next < horizon_.size() && horizon_[next].from != horizon_[i].to) ++next;
      if (next == horizon_.size()) return false;
      std::swap(horizon_[i + 1], horizon_[next]);
    }
    return horizon_.size() >= 3 && horizon_.back().to == horizon_.front().from;
  }

  void Skip(int face) {
    Face& f = faces_[face];
    skipped_ = std::max(skipped_, f.farthest_height);
    std::vector<int> rest;
    AppendOutside(f, f.farthest, &rest);
    Empty(face);
    Distribute(rest, {face});
  }

  // Looks from the point farthest above `face`; then from any farther point, or equally far one
  // nearer a corner, in the list of another visible face.
  int Outermost(int face) {
    int apex = faces_[face].farthest;
    Look(face, points_[apex]);
    for (int step = 0; step < 4; ++step) {
      int best = apex;
      double highest = faces_[face].Height(points_[apex]);
      for (const int f : seen_) {
        for (int p = faces_[f].first; p >= 0; p = next_[p]) {
          const double height = faces_[face].Height(points_[p]);
          if (height < highest - kTie * diagonal_) continue;
          const bool farther =
              (points_[p] - middle_).squaredNorm() > (points_[best] - middle_).squaredNorm();
          if (height > highest + kTie * diagonal_ || farther) {
            highest = std::max(highest, height);
            best = p;
          }
        }
      }
      if (best == apex) break;
      apex = best;
      Look(face, points_[apex]);
    }
    return apex;
  }

  void Add(int face) {
    const int apex = Outermost(face);
    if (!OrderHorizon()) {
      Skip(face);
      return;
    }
    orphans_.clear();
    for (const int f : seen_) {
      faces_[f].alive = false;
      AppendOutside(faces_[f], apex, &orphans_);
      Empty(f);
    }
    added_.clear();
    for (const HorizonEdge& edge : horizon_) {
      const int f = NewFace(edge.from, edge.to, apex);
      added_.push_back(f);
      faces_[f].neighbour[0] = edge.face;
      faces_[edge.face].neighbour[edge.edge] = f;
    }
    const std::size_t count = added_.size();
    for (std::size_t i = 0; i < count; ++i) {
      faces_[added_[i]].neighbour[1] = added_[(i + 1) % count];
      faces_[added_[i]].neighbour[2] = added_[(i + count - 1) % count];
    }
    free_.insert(free_.end(), seen_.begin(), seen_.end());
    ++used_;
    Distribute(orphans_, added_);
  }

  const std::vector<Vector3d>& points_;
  double diagonal_;
  double tolerance_;
  Vector3d middle_;
  Vector3d inside_ = Vector3d::Zero();
  std::vector<Face> faces_;
  std::vector<double> height_;  // of the farthest point outside of each face; kNone: none
  std::vector<int> next_;       // of each point: the next one outside of the same face, or -1
  std::vector<double> packed_;  // faces by coordinate, in Distribute
  std::vector<int> free_, pending_, seen_, added_, orphans_;
  std::vector<HorizonEdge> horizon_;
  int visit_ = 0;
  int used_ = 0;
  double skipped_ = 0.0;
};

}  // namespace simwright::geometry
