#pragma once

#include <Eigen/Core>

#include "render/ray_packet.h"

struct RTCDeviceTy;  // Embree's
struct RTCSceneTy;

namespace simwright::render {

// PacketQuery::part: each hit's geometry stands as its part.
inline constexpr int kGeometryIsPart = -1;

// A query of a packet of rays, whose parameters lie in (near, PacketHits::depth).
struct PacketQuery {
  RTCSceneTy* scene = nullptr;
  bool wide = false;  // traces 16 rays together, else 8 (HasWidePackets)
  Eigen::Vector3f origin;
  float near = 0.0f;
  int part = kGeometryIsPart;
};

// Returns true if this processor traces 16 rays together.
bool HasWidePackets(RTCDeviceTy* device);

// Replaces the hits of the traced rays by nearer ones of the query's scene.
void IntersectPacket(const PacketQuery& query, const PacketDirections& directions,
                     PacketHits* hits);

}  // namespace simwright::render
