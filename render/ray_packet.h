#pragma once

namespace simwright::render {

// The number of rays that are traced together.
inline constexpr int kPacket = 16;

// The directions of a packet of rays from one origin, and which of them are traced.
struct alignas(64) PacketDirections {
  float x[kPacket], y[kPacket], z[kPacket];
  int valid[kPacket];  // -1: traced, 0: not
};

// The nearest hits of a packet.
struct alignas(64) PacketHits {
  float depth[kPacket];  // ray parameter: a multiple of the direction's length
  float u[kPacket], v[kPacket];
  int part[kPacket];  // -1: none
  int triangle[kPacket];
};

}  // namespace simwright::render
