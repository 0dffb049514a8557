#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

namespace simwright::render {

// What a ray met.
struct Hit {
  float depth = 0.0f;        // ray parameter: a multiple of the direction's length
  int instance = -1;         // index of the geometry in the order of adding; -1: nothing was met
  int triangle = -1;         // of that instance's mesh
  float u = 0.0f, v = 0.0f;  // barycentric weights of the triangle's corners 1 and 2
};

// Faces that a ray passes through as if they were not there.
struct IgnoredFaces {
  int instance = -1;
  const int* triangles = nullptr;
  int count = 0;
};

// The one place that speaks to Embree: triangles in one frame, met by rays (ROBUST). Vertices may
// move afterwards; then the trees are refitted, not rebuilt.
// Queries are const and safe from several threads.
class RayTree {
 public:
  RayTree();
  ~RayTree();
  RayTree(const RayTree&) = delete;
  RayTree& operator=(const RayTree&) = delete;

  // Adds a copy of the triangles; returns the geometry's index. `moves`: built for refitting from
  // the start, which costs rays a little.
  int Add(const std::vector<Eigen::Vector3f>& vertices,
          const std::vector<Eigen::Vector3i>& triangles, bool moves);

  // Replaces the vertices (as many as before). Call Commit after.
  void Move(int geometry, const std::vector<Eigen::Vector3f>& vertices);

  // Builds or refits; needed after Add and Move, before any query.
  void Commit();

  // The nearest hit of origin + t * direction with t in (near, far).
  Hit Intersect(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                float far) const;
  // The same for up to eight rays from one origin that lie close together: twice as fast as one by
  // one. `count` directions, `count` hits.
  static constexpr int kBundle = 8;
  void IntersectBundle(const Eigen::Vector3f& origin, const Eigen::Vector3f* directions, int count,
                       float near, float far, Hit* hits) const;
  // As Intersect, blind to `ignored`.
  Hit IntersectIgnoring(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                        float far, const IgnoredFaces& ignored) const;
  // Whether anything is met with t in (near, far).
  bool Occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                float far) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace simwright::render
