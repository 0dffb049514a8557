#include <algorithm>
#include <cmath>

#include "texture/materials/noise.h"
#include "texture/materials/substances.h"

namespace simwright::texture {
namespace {

// The colour and relief of a weave in its plane.
struct Weave {
  float tone = 0.0f;    // about [-1, 1]
  float height = 0.0f;  // [0, 1]
};

Weave WeaveAt(const Eigen::Vector2f& at, float period, float footprint, std::uint32_t seed) {
  const float s = at.x() / period, t = at.y() / period;
  const int i = static_cast<int>(std::floor(s)), j = static_cast<int>(std::floor(t));
  const float u = s - std::floor(s), v = t - std::floor(t);
  const bool warp_above = ((i + j) & 1) != 0;
  // A thread bulges across and dips where it passes below its neighbours.
  const float across = std::sin(3.1415927f * (warp_above ? u : v));
  const float along = std::sin(3.1415927f * (warp_above ? v : u));
  const int thread = warp_above ? i : j;
  const float slub = CellUniform(thread, warp_above ? 1 : 2, 0, seed) - 0.5f;
  const float run = GradientNoise({warp_above ? 0.12f * t : 0.12f * s,
                                   3.7f * static_cast<float>(thread), warp_above ? 0.0f : 9.0f},
                                  seed + 1);
  const float visible = Visible(period, footprint);
  Weave weave;
  weave.height = visible * std::sqrt(std::max(0.0f, across)) * (0.55f + 0.45f * along);
  weave.tone = visible * (weave.height - 0.55f) * 1.4f + 0.35f * slub + 0.4f * run;
  return weave;
}

// Blends a function of two coordinates over the three planes of space, by the normal.
template <typename Function>
Weave ByPlanes(const Eigen::Vector3f& p, const Eigen::Vector3f& normal, const Function& function) {
  Eigen::Vector3f weight = normal.cwiseAbs().array().pow(6.0f);
  weight /= std::max(1e-9f, weight.sum());
  const Eigen::Vector2f planes[3] = {{p.y(), p.z()}, {p.x(), p.z()}, {p.x(), p.y()}};
  Weave sum;
  for (int k = 0; k < 3; ++k) {
    if (weight[k] < 0.02f) continue;
    const Weave one = function(planes[k]);
    sum.tone += weight[k] * one.tone;
    sum.height += weight[k] * one.height;
  }
  return sum;
}

}  // namespace

MaterialSample FabricAt(const SurfaceMaterial& m, const PartFrame& frame,
                        const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 47u;
  const float period = std::max(0.0011f * m.scale, 4.0f * point.footprint);
  const Weave weave = ByPlanes(point.position, point.normal, [&](const Eigen::Vector2f& at) {
    return WeaveAt(at, period, point.footprint, seed);
  });
  const float cloud = FractalNoise(point.position / 0.09f, 3, point.footprint / 0.09f, seed + 3);
  MaterialSample sample;
  sample.color = PatternedColor(m, frame, point);
  sample.color *= 1.0f + m.strength * 0.16f * weave.tone + 0.05f * cloud;
  sample.roughness = m.roughness;
  sample.height = 0.18f * period * weave.height;
  return sample;
}

MaterialSample FeltAt(const SurfaceMaterial& m, const PartFrame& frame,
                      const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 53u;
  const Eigen::Vector3f& p = point.position;
  const float length = std::max(0.0016f * m.scale, 2.0f * point.footprint);
  const float fuzz = FractalNoise(p / length, 3, point.footprint / length, seed, 0.7f);
  const float cloud = FractalNoise(p / 0.03f, 4, point.footprint / 0.03f, seed + 1);
  MaterialSample sample;
  sample.color = PatternedColor(m, frame, point) * (1.0f + 0.20f * fuzz + 0.07f * cloud);
  sample.roughness = m.roughness;
  sample.height = 0.25f * length * fuzz;
  return sample;
}

MaterialSample LeatherAt(const SurfaceMaterial& m, const PartFrame& frame,
                         const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 59u;
  const float cell = std::max(0.0019f * m.scale, 3.0f * point.footprint);
  const Eigen::Vector3f p = point.position / cell;
  const CellPoint pebble =
      CellNoise(p + 0.25f * Eigen::Vector3f::Constant(GradientNoise(0.6f * p, seed + 1)), seed);
  const float crease = 1.0f - SmoothStep(0.02f, 0.22f, pebble.second - pebble.nearest);
  const float cloud = FractalNoise(point.position / 0.06f, 4, point.footprint / 0.06f, seed + 2);
  MaterialSample sample;
  sample.color = PatternedColor(m, frame, point);
  sample.color *= 1.0f + 0.10f * cloud + 0.08f * (HashUniform(pebble.id, 4) - 0.5f);
  sample.color = Mix(sample.color, 0.6f * sample.color, 0.5f * m.strength * crease);
  sample.roughness = m.roughness + 0.15f * crease;
  sample.height = -0.09f * cell * crease;
  return sample;
}

MaterialSample PaperAt(const SurfaceMaterial& m, const PartFrame& frame,
                       const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 61u;
  const Eigen::Vector3f& p = point.position;
  const float fibre = FractalNoise(p / 0.0014f, 3, point.footprint / 0.0014f, seed);
  const float cloud = FractalNoise(p / 0.06f, 3, point.footprint / 0.06f, seed + 1);
  MaterialSample sample;
  sample.color = PatternedColor(m, frame, point) * (1.0f + 0.02f * fibre + 0.02f * cloud);
  sample.roughness = m.roughness;
  sample.height = 8e-6f * fibre;
  return sample;
}

MaterialSample CardboardAt(const SurfaceMaterial& m, const PartFrame& frame,
                           const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 67u;
  const Eigen::Vector3f& p = point.position;
  const Eigen::Vector3f stretched(p.x() / 0.004f, p.y() / 0.004f, p.z() / 0.0012f);
  const float fibre = FractalNoise(stretched, 3, point.footprint / 0.0012f, seed);
  const CellPoint fleck = CellNoise(p / 0.006f, seed + 1);
  const float flecks = (1.0f - SmoothStep(0.04f, 0.14f, fleck.nearest)) *
                       (HashUniform(fleck.id, 3) - 0.4f) * Visible(0.0014f, point.footprint);
  const float cloud = FractalNoise(p / 0.08f, 3, point.footprint / 0.08f, seed + 2);
  // The flutes show through the liner.
  const float flute = std::sin(6.2831853f * (p.x() + p.y()) / 0.0072f) *
                      (std::abs(point.normal.z()) < 0.8f ? 1.0f : 0.0f) *
                      Visible(0.0072f, point.footprint);
  MaterialSample sample;
  sample.color = PatternedColor(m, frame, point);
  sample.color *= 1.0f + 0.05f * fibre + 0.05f * cloud - 0.10f * flecks + 0.018f * flute;
  sample.roughness = m.roughness;
  sample.height = 6e-5f * flute + 1e-5f * fibre;
  return sample;
}

MaterialSample CorkAt(const SurfaceMaterial& m, const PartFrame&, const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 71u;
  const float cell = std::max(0.0032f * m.scale, 3.0f * point.footprint);
  const Eigen::Vector3f p = point.position / cell;
  const CellPoint granule = CellNoise(p + 0.4f * Eigen::Vector3f(GradientNoise(1.5f * p, seed + 1),
                                                                 GradientNoise(1.5f * p, seed + 2),
                                                                 GradientNoise(1.5f * p, seed + 3)),
                                      seed);
  const float tone = HashUniform(granule.id, 3);
  const float gap = 1.0f - SmoothStep(0.0f, 0.12f, granule.second - granule.nearest);
  const float grain = FractalNoise(4.0f * p, 2, 4.0f * point.footprint / cell, seed + 4);
  MaterialSample sample;
  sample.color = Mix(m.color, m.second, 0.8f * tone * tone + 0.15f * grain);
  sample.color = Mix(sample.color, 0.5f * m.second, 0.6f * gap);
  sample.roughness = m.roughness;
  sample.height = -0.06f * cell * gap;
  return sample;
}

MaterialSample PlasticAt(const SurfaceMaterial& m, const PartFrame& frame,
                         const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 73u;
  const Eigen::Vector3f& p = point.position;
  const float grain = FractalNoise(p / 0.0009f, 2, point.footprint / 0.0009f, seed);
  const float cloud = FractalNoise(p / 0.1f, 3, point.footprint / 0.1f, seed + 1);
  MaterialSample sample;
  sample.color = PatternedColor(m, frame, point) * (1.0f + 0.015f * cloud + 0.012f * grain);
  sample.roughness = m.roughness + 0.03f * cloud + 0.03f * grain;
  sample.height = 7e-6f * grain * SmoothStep(0.3f, 0.6f, m.roughness);
  return sample;
}

MaterialSample RubberAt(const SurfaceMaterial& m, const PartFrame& frame,
                        const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 79u;
  const Eigen::Vector3f& p = point.position;
  const float pebble = std::max(0.0022f * m.scale, 3.0f * point.footprint);
  const CellPoint bump = CellNoise(p / pebble, seed);
  const float dome =
      m.figure == SkinFigure::kPores ? 1.0f - SmoothStep(0.1f, 0.55f, bump.nearest) : 0.0f;
  const float dust = FractalNoise(p / 0.04f, 5, point.footprint / 0.04f, seed + 1, 0.6f);
  MaterialSample sample;
  sample.color = PatternedColor(m, frame, point);
  sample.color *= 1.0f + 0.10f * dust + 0.10f * dome;
  sample.roughness = m.roughness + 0.05f * dust;
  sample.height = 0.12f * pebble * dome;
  return sample;
}

MaterialSample WaxAt(const SurfaceMaterial& m, const PartFrame& frame, const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 83u;
  const Eigen::Vector3f& p = point.position;
  const Eigen::Vector3f bent =
      p / 0.03f + Eigen::Vector3f::Constant(0.6f * GradientNoise(p / 0.025f, seed));
  const float swirl = FractalNoise(bent, 3, point.footprint / 0.03f, seed + 1);
  MaterialSample sample;
  sample.color = Mix(PatternedColor(m, frame, point), m.second,
                     m.strength * 0.5f * SmoothStep(0.0f, 0.6f, swirl));
  sample.roughness = m.roughness + 0.04f * swirl;
  sample.height = 2e-5f * swirl;
  return sample;
}

}  // namespace simwright::texture
