#include "core/random.h"

#include <cmath>
#include <numbers>

namespace simwright::core {

double Normal(Rng& rng) {
  const double radius = std::sqrt(-2.0 * std::log1p(-Uniform(rng)));
  return radius * std::cos(2.0 * std::numbers::pi * Uniform(rng));
}

Eigen::Vector3d UniformDirection(Rng& rng) {
  // The height of a uniform point on the sphere is uniform (Archimedes).
  const double z = Uniform(rng, -1.0, 1.0);
  const double azimuth = Uniform(rng, 0.0, 2.0 * std::numbers::pi);
  const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
}

Rng StreamRng(std::uint64_t seed, std::uint64_t stream) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(stream),
                         static_cast<std::uint32_t>(stream >> 32)};
  return Rng(sequence);
}

}  // namespace simwright::core
