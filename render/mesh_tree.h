#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "render/ray_packet.h"

namespace simwright::render {

// The rays of a pinhole camera in one frame: the ray through image point (x, y) leaves `origin`
// towards `at_zero` + x * `per_x` + y * `per_y`, whose component along the optical axis is 1.
struct PixelRays {
  Eigen::Vector3f origin, at_zero, per_x, per_y;
};

// The image points of a packet, and which of them are traced.
struct alignas(64) PacketPixels {
  float x[kPacket], y[kPacket];
  int valid[kPacket];  // -1: traced, 0: not
};

// The shadow rays of a packet in one frame: from each point towards `direction`.
struct alignas(64) PacketShadows {
  float x[kPacket], y[kPacket], z[kPacket];
  int open[kPacket];  // -1: not occluded so far, 0: occluded or not asked for
  Eigen::Vector3f direction;
};

// A ray tree (ROBUST) over the triangles of one mesh in the mesh's own frame, on Embree. Immutable
// and thread-safe.
class MeshTree {
 public:
  // Copies the triangles. Throws core::Error if Embree cannot start.
  MeshTree(const std::vector<Eigen::Vector3f>& vertices,
           const std::vector<Eigen::Vector3i>& triangles);
  ~MeshTree();
  MeshTree(const MeshTree&) = delete;
  MeshTree& operator=(const MeshTree&) = delete;

  // Replaces the hits of `hits` behind which this mesh, part `part`, is nearer. `rays`: in the
  // mesh's frame.
  void Intersect(const PixelRays& rays, const PacketPixels& pixels, int part,
                 PacketHits* hits) const;
  // Clears `open` of the points from which this mesh is met. `shadows`: in the mesh's frame.
  void Occlude(PacketShadows* shadows) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace simwright::render
