#include "render/surface_look.h"

#include <cmath>

namespace simwright::render {
namespace {

// Hashes lattice coordinates (Wellons, "lowbias32", chained) to [0, 1).
float LatticeHash(int x, int y, int z, std::uint32_t seed) {
  std::uint32_t hash = seed;
  for (const int i : {x, y, z}) {
    hash ^= static_cast<std::uint32_t>(i) + 0x9e3779b9u;
    hash = (hash ^ (hash >> 16)) * 0x7feb352du;
    hash = (hash ^ (hash >> 15)) * 0x846ca68bu;
    hash ^= hash >> 16;
  }
  return static_cast<float>(hash) * 0x1.0p-32f;
}

float SmoothStep(float t) {
  return t * t * (3.0f - 2.0f * t);
}

// Returns value noise of one octave: hashed lattice values, smoothly interpolated.
float ValueNoise(const Eigen::Vector3f& p, std::uint32_t seed) {
  const Eigen::Vector3f cell = p.array().floor();
  const Eigen::Vector3i i = cell.cast<int>();
  const Eigen::Vector3f f = p - cell;
  const float weight[3] = {SmoothStep(f.x()), SmoothStep(f.y()), SmoothStep(f.z())};
  float sum = 0.0f;
  for (int k = 0; k < 8; ++k) {
    const int dx = k & 1, dy = (k >> 1) & 1, dz = k >> 2;
    sum += (dx ? weight[0] : 1.0f - weight[0]) * (dy ? weight[1] : 1.0f - weight[1]) *
           (dz ? weight[2] : 1.0f - weight[2]) *
           LatticeHash(i.x() + dx, i.y() + dy, i.z() + dz, seed);
  }
  return sum;
}

float Noise(const Eigen::Vector3f& p, std::uint32_t seed) {
  const float sum = (4.0f * ValueNoise(p, seed) + 2.0f * ValueNoise(2.0f * p, seed + 1) +
                     ValueNoise(4.0f * p, seed + 2)) /
                    7.0f;
  return SmoothStep(std::min(1.0f, std::max(0.0f, 2.0f * sum - 0.5f)));
}

// Planks five times as long as wide, each with a hashed shade, offset from row to row.
float Planks(const Eigen::Vector3f& p, std::uint32_t seed) {
  constexpr float kGap = 0.03f, kLength = 5.0f;
  const float row = std::floor(p.y()), across = p.y() - row;
  const int r = static_cast<int>(row);
  const float along = p.x() / kLength + LatticeHash(r, 0, 7, seed);
  const float column = std::floor(along), within = (along - column) * kLength;
  if (across < kGap || within < kGap) return 1.0f;
  return 0.6f * LatticeHash(r, static_cast<int>(column), 3, seed);
}

}  // namespace

float PatternShare(const SurfaceLook& look, const Eigen::Vector3f& point) {
  // The offset keeps lattice planes off the flat sides of meshes and the floor.
  const Eigen::Vector3f p = point / look.pattern_size + Eigen::Vector3f(0.137f, 0.251f, 0.389f);
  float share = 0.0f;
  switch (look.pattern) {
    case Pattern::kNone:
      return 0.0f;
    case Pattern::kChecker: {
      const Eigen::Vector3i i = p.array().floor().cast<int>();
      share = static_cast<float>((i.x() + i.y() + i.z()) & 1);
      break;
    }
    case Pattern::kStripes:
      share = static_cast<float>(static_cast<int>(std::floor(p.x())) & 1);
      break;
    case Pattern::kNoise:
      share = Noise(p, look.pattern_seed);
      break;
    case Pattern::kPlanks:
      share = Planks(p, look.pattern_seed);
      break;
  }
  return look.pattern_strength * share;
}

}  // namespace simwright::render
