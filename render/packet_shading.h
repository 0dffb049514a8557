#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "render/mesh_tree.h"
#include "render/rigid_mesh_content.h"
#include "render/rigid_scene.h"

namespace simwright::render {

// PacketHits::part beside parts: nothing, the floor, and the walls at the ends of the x and y
// ranges.
inline constexpr int kNoHit = -1, kFloorHit = -2, kWallHit = -3;  // walls: -3 .. -6

// A part as one camera sees it.
struct SeenPart {
  int index = 0;
  const RigidMesh::Content* mesh = nullptr;
  PixelRays rays;                      // mesh frame
  Eigen::Matrix3f world_from_part;     // rotation
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // pixels that it may cover, [x0, x1) x [y0, y1)
  float nearest = 0.0f;                // m along the optical axis: no point of it is nearer
};

// A scene as one camera sees it: the parts in view, nearest first. `parts` keeps its memory from
// image to image.
struct SeenScene {
  const RigidScene* scene = nullptr;
  PixelRays rays;  // world
  std::vector<SeenPart> parts;

  void See(const RigidScene& seen, const core::Camera& camera);
};

// Normals and albedo of a packet's hits.
struct alignas(64) PacketSurface {
  float normal[3][kPacket];  // unit, world, facing the camera; 0 without a hit
  float albedo[3][kPacket];  // linear RGB; the background's without a hit
  // Reflection of hits whose mesh has a look: F0, and roughness, negative for all others.
  bool reflects = false;
  float f0[3][kPacket];
  float roughness[kPacket];
};

// Writes the hits on floor and walls, and kNoHit elsewhere.
void IntersectBackdrop(const SeenScene& seen, const PacketPixels& pixels, PacketHits* hits);

// Fills `surface`; the albedo only if `colored`.
void EvaluateSurface(const SeenScene& seen, const PacketPixels& pixels, const PacketHits& hits,
                     bool colored, PacketSurface* surface);

// Replaces the albedo of hits by the light that they reflect, linear RGB.
void Illuminate(const SeenScene& seen, const PacketPixels& pixels, const PacketHits& hits,
                PacketSurface* surface);

}  // namespace simwright::render
