#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace simwright::texture {

// Return a hash of an integer cell and a seed, as an integer and as a number in [0, 1).
std::uint32_t CellHash(int x, int y, int z, std::uint32_t seed);
float CellUniform(int x, int y, int z, std::uint32_t seed);

// Returns gradient noise of wavelength about 1 in about [-1, 1], mean 0 (Perlin, "Improving noise",
// 2002).
float GradientNoise(const Eigen::Vector3f& p, std::uint32_t seed);

// Returns the sum of `octaves` gradient noises, each of half the wavelength and `gain` times the
// amplitude of the one before. Octaves whose wavelength is below twice `footprint` fade out, so
// that a texture of that spacing does not alias; p and footprint have one unit.
float FractalNoise(const Eigen::Vector3f& p, int octaves, float footprint, std::uint32_t seed,
                   float gain = 0.5f);

// The nearest of the points that are scattered one per unit cell.
struct CellPoint {
  float nearest = 0.0f, second = 0.0f;  // distances to the nearest two
  std::uint32_t id = 0;                 // a hash of the nearest
  Eigen::Vector3f offset{0, 0, 0};      // from the nearest point to p
};
// Worley, "A cellular texture basis function", 1996.
CellPoint CellNoise(const Eigen::Vector3f& p, std::uint32_t seed);

// Returns 0 below `from`, 1 above `to`, smooth between.
float SmoothStep(float from, float to, float value);
// Returns 1 where features of `wavelength` show at a spacing of `footprint`, 0 where they do not.
float Visible(float wavelength, float footprint);
// Returns `a` at share 0 and `b` at share 1.
Eigen::Vector3f Mix(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float share);
// Returns the number in [0, 1) that a hash makes; `stream` makes several of one hash.
float HashUniform(std::uint32_t hash, std::uint32_t stream);

}  // namespace simwright::texture
