#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "render/hit.h"
#include "render/ray_packet.h"

namespace simwright::render {

// Faces that a ray ignores.
struct IgnoredFaces {
  int instance = -1;
  const int* triangles = nullptr;
  int count = 0;
};

// A ray tree over triangles in one frame (ROBUST), on Embree; mesh_tree.h has the one for packets.
// If vertices move, the trees are refitted, not rebuilt. Queries are const and thread-safe.
class RayTree {
 public:
  RayTree();
  ~RayTree();
  RayTree(const RayTree&) = delete;
  RayTree& operator=(const RayTree&) = delete;

  // Adds a copy of the triangles; returns the geometry's index. `moves` builds for refitting from
  // the start, at a small cost per ray.
  int Add(const std::vector<Eigen::Vector3f>& vertices,
          const std::vector<Eigen::Vector3i>& triangles, bool moves);

  // Replaces the vertices (the same number). Call Commit afterwards.
  void Move(int geometry, const std::vector<Eigen::Vector3f>& vertices);

  // Builds or refits the trees; required after Add and Move, before any query.
  void Commit();

  // Returns the nearest hit of origin + t * direction with t in (near, far).
  Hit Intersect(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                float far) const;
  // Writes the hits of nearby rays from one origin, as Intersect returns them, several times
  // faster. PacketHits::part is the geometry; untraced rays have no hit.
  void IntersectPacket(const Eigen::Vector3f& origin, const PacketDirections& directions,
                       float near, float far, PacketHits* hits) const;
  // Intersects while ignoring the faces `ignored`.
  Hit IntersectIgnoring(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                        float far, const IgnoredFaces& ignored) const;
  // Returns true if anything is hit with t in (near, far).
  bool Occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float near,
                float far) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace simwright::render
