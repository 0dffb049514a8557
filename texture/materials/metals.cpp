#include <algorithm>
#include <cmath>

#include "texture/materials/noise.h"
#include "texture/materials/substances.h"

namespace simwright::texture {
namespace {

// Returns coordinates whose first runs along the brush strokes: around a round part, else along the
// part's longest direction, m.
Eigen::Vector3f InBrush(const PartFrame& frame, const Eigen::Vector3f& position) {
  const Eigen::Vector3f p = position - frame.box.center();
  if (frame.round) {
    const float radius = p.head<2>().norm();
    // Around: a few waves per turn, closed by taking the point on a circle.
    return {radius, p.z(), 0.0f};
  }
  const Eigen::Vector3f& along = frame.grain;
  const Eigen::Vector3f helper =
      std::abs(along.z()) < 0.9f ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f::UnitX();
  const Eigen::Vector3f across = along.cross(helper).normalized();
  return {p.dot(across), p.dot(along.cross(across)), p.dot(along)};
}

float Tarnish(const SurfaceMaterial& m, const MaterialPoint& point, std::uint32_t seed) {
  if (m.wear <= 0.0f) return 0.0f;
  const Eigen::Vector3f& p = point.position;
  const float cloud = FractalNoise(p / 0.05f, 6, point.footprint / 0.05f, seed, 0.65f);
  return std::clamp(m.wear * SmoothStep(0.15f - 0.35f * m.wear, 0.55f, cloud), 0.0f, 1.0f);
}

}  // namespace

MaterialSample BrushedMetalAt(const SurfaceMaterial& m, const PartFrame& frame,
                              const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + frame.seed + 31u;
  const Eigen::Vector3f b = InBrush(frame, point.position);
  const float fine = std::max(0.00035f, 3.0f * point.footprint);
  const float coarse = 4.0f * fine;
  const float along = frame.round ? 0.0f : b.z() / 0.06f;
  const float stroke =
      GradientNoise({b.x() / fine, b.y() / fine, along}, seed) +
      0.6f * GradientNoise({b.x() / coarse, b.y() / coarse, 0.6f * along}, seed + 1);
  const float cloud = FractalNoise(point.position / 0.08f, 3, point.footprint / 0.08f, seed + 2);
  const float tarnish = Tarnish(m, point, seed + 3);
  MaterialSample sample;
  sample.color = m.color * (1.0f + m.strength * (0.055f * stroke + 0.025f * cloud));
  sample.color = Mix(sample.color, m.second, 0.8f * tarnish);
  sample.roughness = m.roughness + 0.07f * stroke + 0.4f * tarnish;
  sample.metallic = 1.0f - 0.8f * tarnish;
  sample.height = 4e-6f * stroke;
  return sample;
}

MaterialSample PolishedMetalAt(const SurfaceMaterial& m, const PartFrame& frame,
                               const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + frame.seed + 37u;
  const Eigen::Vector3f& p = point.position;
  const float cloud = FractalNoise(p / 0.05f, 4, point.footprint / 0.05f, seed);
  // Hairline scratches: the zero lines of noises stretched in turned directions.
  float scratch = 0.0f;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t h = CellHash(static_cast<int>(k), 4, 9, seed);
    const Eigen::Vector3f d = Eigen::Vector3f(HashUniform(h, 0) - 0.5f, HashUniform(h, 1) - 0.5f,
                                              HashUniform(h, 2) - 0.5f)
                                  .normalized();
    const float along = p.dot(d);
    const Eigen::Vector3f stretched = (p - 0.94f * along * d) / 0.006f;
    const float line =
        1.0f - SmoothStep(0.0f, 0.035f, std::abs(GradientNoise(stretched, seed + k)));
    scratch =
        std::max(scratch, line * SmoothStep(0.1f, 0.5f, GradientNoise(p / 0.02f, seed + 7 + k)));
  }
  scratch *= Visible(0.0009f, point.footprint) * m.strength;
  const float tarnish = Tarnish(m, point, seed + 11);
  MaterialSample sample;
  sample.color = m.color * (1.0f + 0.03f * cloud + 0.08f * scratch);
  sample.color = Mix(sample.color, m.second, 0.8f * tarnish);
  sample.roughness = m.roughness + 0.04f * cloud + 0.12f * scratch + 0.45f * tarnish;
  sample.metallic = 1.0f - 0.8f * tarnish;
  return sample;
}

MaterialSample CastMetalAt(const SurfaceMaterial& m, const PartFrame&, const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 41u;
  const Eigen::Vector3f& p = point.position;
  const float grain = FractalNoise(p / 0.0022f, 3, point.footprint / 0.0022f, seed, 0.6f);
  const float cloud = FractalNoise(p / 0.04f, 4, point.footprint / 0.04f, seed + 1);
  const float rust = Tarnish(m, point, seed + 2);
  MaterialSample sample;
  sample.color = m.color * (1.0f + 0.16f * grain + 0.10f * cloud);
  sample.color = Mix(sample.color, m.second * (1.0f + 0.25f * grain), 0.85f * rust);
  sample.roughness = m.roughness + 0.08f * grain + 0.2f * rust;
  sample.metallic = 1.0f - 0.9f * rust;
  sample.height = 6e-5f * grain;
  return sample;
}

MaterialSample PaintAt(const SurfaceMaterial& m, const PartFrame& frame,
                       const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 43u;
  const Eigen::Vector3f& p = point.position;
  const float peel = FractalNoise(p / 0.0018f, 2, point.footprint / 0.0018f, seed);
  const float cloud = FractalNoise(p / 0.12f, 3, point.footprint / 0.12f, seed + 1);
  MaterialSample sample;
  sample.color = PatternedColor(m, frame, point) * (1.0f + 0.025f * cloud + 0.008f * peel);
  sample.roughness = m.roughness + 0.03f * cloud;
  sample.height = 1.2e-5f * peel;
  if (m.wear <= 0.0f) return sample;
  // Chips: islands of a noise, ragged by a finer one, in the places that get knocks.
  const float place = FractalNoise(p / 0.07f, 2, point.footprint / 0.07f, seed + 2);
  const float chip = FractalNoise(p / 0.009f, 4, point.footprint / 0.009f, seed + 3, 0.6f);
  const float bare = SmoothStep(0.0f, 0.05f, chip + 0.5f * place - (0.95f - 0.55f * m.wear));
  sample.color = Mix(sample.color, m.second, bare);
  sample.roughness += bare * (0.5f - sample.roughness);
  sample.metallic = bare;
  sample.height -= 8e-5f * bare;
  return sample;
}

}  // namespace simwright::texture
