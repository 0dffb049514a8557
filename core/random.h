#pragma once

#include <cstdint>
#include <random>

#include <Eigen/Core>

namespace simwright::core {

// The generator handed to everything that draws. Nothing keeps one of its own.
using Rng = std::mt19937_64;

// Uniform in [0, 1), from the top 53 bits: the same on every standard library.
inline double Uniform(Rng& rng) {
  return static_cast<double>(rng() >> 11) * 0x1.0p-53;
}

// Uniform in [low, high).
inline double Uniform(Rng& rng, double low, double high) {
  return low + (high - low) * Uniform(rng);
}

// Uniform over 0 .. count-1. Requires count >= 1. The bias is below count / 2^53.
inline std::int64_t UniformIndex(Rng& rng, std::int64_t count) {
  return static_cast<std::int64_t>(Uniform(rng) * static_cast<double>(count));
}

// Standard normal by Box-Muller (one of the pair is discarded).
double Normal(Rng& rng);

// Uniform on the unit sphere.
Eigen::Vector3d UniformDirection(Rng& rng);

// A generator for part `stream` of the work seeded by `seed`, independent of the other parts:
// parallel work draws from one stream an item and stays the same for any number of threads.
Rng StreamRng(std::uint64_t seed, std::uint64_t stream);

}  // namespace simwright::core
