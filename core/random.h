#pragma once

#include <cstdint>
#include <random>

#include <Eigen/Core>

namespace simwright::core {

// The random generator, always passed in by the caller; no component owns one.
using Rng = std::mt19937_64;

// Samples uniformly from [0, 1) using the top 53 bits: the same on every standard library.
inline double Uniform(Rng& rng) {
  return static_cast<double>(rng() >> 11) * 0x1.0p-53;
}

// Samples uniformly from [low, high).
inline double Uniform(Rng& rng, double low, double high) {
  return low + (high - low) * Uniform(rng);
}

// Samples uniformly from 0 .. count-1. Requires count >= 1. The bias is below count / 2^53.
inline std::int64_t UniformIndex(Rng& rng, std::int64_t count) {
  return static_cast<std::int64_t>(Uniform(rng) * static_cast<double>(count));
}

// Samples a standard normal by Box-Muller (the second value of the pair is discarded).
double Normal(Rng& rng);

// Samples uniformly from the unit sphere.
Eigen::Vector3d UniformDirection(Rng& rng);

// Returns the generator of part `stream` of the work seeded by `seed`, independent of the other
// parts. Parallel work uses one stream per item, so its results do not depend on the number of
// threads.
Rng StreamRng(std::uint64_t seed, std::uint64_t stream);

}  // namespace simwright::core
