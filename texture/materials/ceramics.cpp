#include <algorithm>
#include <cmath>

#include "texture/materials/noise.h"
#include "texture/materials/substances.h"

namespace simwright::texture {

MaterialSample GlazeAt(const SurfaceMaterial& m, const PartFrame& frame,
                       const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 11u;
  const Eigen::Vector3f& p = point.position;
  MaterialSample sample;
  sample.color = PatternedColor(m, frame, point);
  // A glaze runs while it melts: thin and light at the rim, thick and deep further down.
  const float height = std::max(frame.box.sizes().z(), 1e-4f);
  const float below_rim = frame.box.max().z() - p.z();
  const Eigen::Vector3f run_place(p.x() / 0.012f, p.y() / 0.012f, p.z() / 0.06f);
  const float run = FractalNoise(run_place, 3, point.footprint / 0.012f, seed);
  const float thin = std::exp(-below_rim / 0.0016f) * m.strength;
  const float pooled = SmoothStep(0.2f, 1.0f, below_rim / height + 0.25f * run);
  const float cloud = FractalNoise(p / 0.05f, 3, point.footprint / 0.05f, seed + 1);
  sample.color *= 1.0f + m.strength * (0.035f * cloud - 0.07f * pooled);
  sample.color = Mix(sample.color, m.second, std::clamp(0.55f * thin, 0.0f, 1.0f));
  // Iron specks of a stoneware body melt through.
  if (m.figure == SkinFigure::kSpots) {
    const CellPoint speck = CellNoise(p / (0.0042f * m.scale), seed + 2);
    const float radius = 0.03f + 0.13f * HashUniform(speck.id, 5) * HashUniform(speck.id, 5);
    const float share = (1.0f - SmoothStep(0.6f * radius, 1.3f * radius, speck.nearest)) *
                        Visible(0.0012f, point.footprint);
    sample.color = Mix(sample.color, 0.45f * m.second, 0.8f * share);
  }
  sample.roughness = m.roughness + 0.02f * cloud;
  sample.height = 4e-5f * cloud;
  // The foot stands bare: a glazed one would stick to the kiln.
  const float foot = (1.0f - SmoothStep(0.0012f, 0.0022f, p.z() - frame.box.min().z())) *
                     SmoothStep(0.5f, 0.9f, -point.normal.z());
  const float grain = FractalNoise(p / 0.0012f, 2, point.footprint / 0.0012f, seed + 3);
  sample.color =
      Mix(sample.color, Eigen::Vector3f(0.80f, 0.75f, 0.67f) * (1.0f + 0.05f * grain), foot);
  sample.roughness += foot * (0.8f - sample.roughness);
  return sample;
}

MaterialSample ClayAt(const SurfaceMaterial& m, const PartFrame& frame,
                      const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 13u;
  const Eigen::Vector3f& p = point.position;
  const float cloud = FractalNoise(p / 0.035f, 4, point.footprint / 0.035f, seed);
  const float grain = FractalNoise(p / 0.0011f, 2, point.footprint / 0.0011f, seed + 1);
  // Fingers leave rings on a turned pot.
  const Eigen::Vector3f rings(0.6f * p.x() / 0.03f, 0.6f * p.y() / 0.03f, p.z() / 0.0026f);
  const float turned =
      frame.round ? FractalNoise(rings, 2, point.footprint / 0.0026f, seed + 2) : 0.0f;
  const float salt =
      SmoothStep(0.18f, 0.6f, FractalNoise(p / 0.05f, 4, point.footprint / 0.05f, seed + 3));
  MaterialSample sample;
  sample.color = PatternedColor(m, frame, point);
  sample.color *= 1.0f + 0.10f * cloud + 0.07f * grain + 0.05f * turned;
  sample.color = Mix(sample.color, m.second, 0.35f * m.strength * salt);
  sample.roughness = m.roughness + 0.04f * grain;
  sample.height = 3e-5f * grain + 9e-5f * turned;
  return sample;
}

MaterialSample GlassAt(const SurfaceMaterial& m, const PartFrame& frame,
                       const MaterialPoint& point) {
  MaterialSample sample;
  sample.color = PatternedColor(m, frame, point);
  // The rim, where one looks along the glass, is deeper in colour.
  const float below_rim = frame.box.max().z() - point.position.z();
  const float above_foot = point.position.z() - frame.box.min().z();
  const float edge = std::exp(-below_rim / 0.002f) + 0.8f * std::exp(-above_foot / 0.004f);
  sample.color = Mix(sample.color, m.second, std::clamp(0.6f * edge, 0.0f, 1.0f));
  const float cloud =
      FractalNoise(point.position / 0.06f, 2, point.footprint / 0.06f, m.seed * 7919u + 17u);
  sample.color *= 1.0f + 0.02f * cloud;
  sample.roughness = m.roughness;
  return sample;
}

MaterialSample StoneAt(const SurfaceMaterial& m, const PartFrame&, const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 19u;
  const Eigen::Vector3f& p = point.position;
  // Granite: crystals of three minerals.
  const float cell = std::max(0.0035f * m.scale, 3.0f * point.footprint);
  const Eigen::Vector3f bent =
      p / cell + 0.35f * Eigen::Vector3f(GradientNoise(2.0f * p / cell, seed + 1),
                                         GradientNoise(2.0f * p / cell, seed + 2), 0.0f);
  const CellPoint crystal = CellNoise(bent, seed);
  const float kind = HashUniform(crystal.id, 3);
  const float tone = 0.85f + 0.3f * HashUniform(crystal.id, 4);
  MaterialSample sample;
  sample.color = kind < 0.55f   ? m.color
                 : kind < 0.82f ? m.second
                                : Eigen::Vector3f(0.25f * m.second);
  sample.color *= tone;
  sample.color *= 1.0f + 0.08f * FractalNoise(p / 0.1f, 3, point.footprint / 0.1f, seed + 3);
  sample.roughness = m.roughness + 0.1f * (HashUniform(crystal.id, 6) - 0.5f);
  return sample;
}

MaterialSample MarbleAt(const SurfaceMaterial& m, const PartFrame& frame,
                        const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 23u;
  const float size = m.scale * std::max(0.06f, 0.35f * frame.box.sizes().maxCoeff());
  const Eigen::Vector3f p = point.position / size;
  const float spacing = point.footprint / size;
  const Eigen::Vector3f bent =
      p + 0.55f * Eigen::Vector3f(FractalNoise(1.7f * p, 4, 1.7f * spacing, seed),
                                  FractalNoise(1.7f * p, 4, 1.7f * spacing, seed + 1),
                                  FractalNoise(1.7f * p, 4, 1.7f * spacing, seed + 2));
  // Veins lie where a noise crosses zero; a second, finer net is fainter.
  const float vein =
      1.0f - SmoothStep(0.0f, 0.075f, std::abs(GradientNoise(1.3f * bent, seed + 3)));
  const float fine = 1.0f - SmoothStep(0.0f, 0.06f, std::abs(GradientNoise(3.1f * bent, seed + 4)));
  const float fade = 0.5f + 0.5f * GradientNoise(0.9f * p, seed + 5);
  const float cloud = FractalNoise(2.0f * p, 4, 2.0f * spacing, seed + 6);
  MaterialSample sample;
  sample.color = m.color * (1.0f + 0.05f * cloud);
  sample.color = Mix(sample.color, m.second, 0.75f * vein * std::clamp(1.3f * fade, 0.0f, 1.0f));
  sample.color = Mix(sample.color, m.second, 0.30f * fine * std::clamp(fade, 0.0f, 1.0f));
  sample.roughness = m.roughness;
  return sample;
}

MaterialSample ConcreteAt(const SurfaceMaterial& m, const PartFrame&, const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 29u;
  const Eigen::Vector3f& p = point.position;
  const float cloud = FractalNoise(p / 0.25f, 6, point.footprint / 0.25f, seed, 0.6f);
  const CellPoint bubble = CellNoise(p / 0.022f, seed + 1);
  const float radius = 0.12f * HashUniform(bubble.id, 3);
  const float hole = (1.0f - SmoothStep(0.7f * radius, radius + 0.02f, bubble.nearest)) *
                     (HashUniform(bubble.id, 4) < 0.5f ? 1.0f : 0.0f) *
                     Visible(0.004f, point.footprint);
  MaterialSample sample;
  sample.color = m.color * (1.0f + 0.14f * cloud);
  sample.color = Mix(sample.color, 0.5f * m.second, 0.7f * hole);
  sample.roughness = m.roughness;
  sample.height = -8e-4f * hole + 1e-4f * cloud;
  return sample;
}

}  // namespace simwright::texture
