#include "texture/materials/noise.h"

#include <algorithm>
#include <cmath>

namespace simwright::texture {
namespace {

std::uint32_t Scramble(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  return h ^ h >> 16;
}

// The dot product of one of twelve gradients with (x, y, z).
float GradientDot(std::uint32_t hash, float x, float y, float z) {
  const std::uint32_t h = hash & 15u;
  const float u = h < 8 ? x : y;
  const float v = h < 4 ? y : h == 12 || h == 14 ? x : z;
  return ((h & 1) ? -u : u) + ((h & 2) ? -v : v);
}

float Fade(float t) {
  return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

}  // namespace

std::uint32_t CellHash(int x, int y, int z, std::uint32_t seed) {
  std::uint32_t h = Scramble(static_cast<std::uint32_t>(x) + 0x9e3779b9u * seed);
  h = Scramble(h ^ (static_cast<std::uint32_t>(y) * 0x85ebca6bu));
  return Scramble(h ^ (static_cast<std::uint32_t>(z) * 0xc2b2ae35u));
}

float HashUniform(std::uint32_t hash, std::uint32_t stream) {
  return static_cast<float>(Scramble(hash + 0x632be5abu * (stream + 1)) >> 8) * 0x1.0p-24f;
}

float CellUniform(int x, int y, int z, std::uint32_t seed) {
  return static_cast<float>(CellHash(x, y, z, seed) >> 8) * 0x1.0p-24f;
}

float GradientNoise(const Eigen::Vector3f& p, std::uint32_t seed) {
  const Eigen::Vector3f floor = p.array().floor();
  const int x = static_cast<int>(floor.x()), y = static_cast<int>(floor.y()),
            z = static_cast<int>(floor.z());
  const Eigen::Vector3f f = p - floor;
  float corner[8];
  for (int c = 0; c < 8; ++c) {
    const int dx = c & 1, dy = c >> 1 & 1, dz = c >> 2 & 1;
    corner[c] = GradientDot(CellHash(x + dx, y + dy, z + dz, seed), f.x() - static_cast<float>(dx),
                            f.y() - static_cast<float>(dy), f.z() - static_cast<float>(dz));
  }
  const float u = Fade(f.x()), v = Fade(f.y()), w = Fade(f.z());
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  const float near = mix(mix(corner[0], corner[1], u), mix(corner[2], corner[3], u), v);
  const float far = mix(mix(corner[4], corner[5], u), mix(corner[6], corner[7], u), v);
  return mix(near, far, w);
}

float Visible(float wavelength, float footprint) {
  return footprint > 0.0f ? SmoothStep(1.6f, 3.5f, wavelength / footprint) : 1.0f;
}

float FractalNoise(const Eigen::Vector3f& p, int octaves, float footprint, std::uint32_t seed,
                   float gain) {
  float sum = 0.0f, amplitude = 1.0f, frequency = 1.0f;
  for (int octave = 0; octave < octaves; ++octave) {
    const float visible = Visible(1.0f / frequency, footprint);
    if (visible <= 0.0f) break;
    sum += visible * amplitude *
           GradientNoise(frequency * p, seed + 101u * static_cast<std::uint32_t>(octave));
    amplitude *= gain;
    frequency *= 2.0f;
  }
  return sum;
}

CellPoint CellNoise(const Eigen::Vector3f& p, std::uint32_t seed) {
  const Eigen::Vector3i base = p.array().floor().cast<int>();
  CellPoint result;
  float nearest = 1e9f, second = 1e9f;
  for (int n = 0; n < 27; ++n) {
    const Eigen::Vector3i cell = base + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    const std::uint32_t hash = CellHash(cell.x(), cell.y(), cell.z(), seed);
    const Eigen::Vector3f point =
        cell.cast<float>() +
        Eigen::Vector3f(HashUniform(hash, 0), HashUniform(hash, 1), HashUniform(hash, 2));
    const float distance = (p - point).squaredNorm();
    if (distance < nearest) {
      second = nearest;
      nearest = distance;
      result.id = hash;
      result.offset = p - point;
    } else if (distance < second) {
      second = distance;
    }
  }
  result.nearest = std::sqrt(nearest);
  result.second = std::sqrt(second);
  return result;
}

float SmoothStep(float from, float to, float value) {
  const float t = std::clamp((value - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

Eigen::Vector3f Mix(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float share) {
  return a + share * (b - a);
}

}  // namespace simwright::texture
