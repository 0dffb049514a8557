#include <algorithm>
#include <cmath>

#include "texture/materials/noise.h"
#include "texture/materials/substances.h"

namespace simwright::texture {
namespace {

// A point of a fruit: its direction from the middle and the place along its axis. The axis is the
// vertical, or the longest direction of a long fruit.
struct FruitPlace {
  float along = 0.0f;                  // [-1, 1] along the axis
  Eigen::Vector3f direction{0, 0, 1};  // unit, in a frame whose z is the axis
};

FruitPlace InFruit(const PartFrame& frame, const Eigen::Vector3f& position) {
  const Eigen::Vector3f size = frame.box.sizes().cwiseMax(1e-6f);
  const bool lies = std::max(size.x(), size.y()) > 1.15f * std::min({size.x(), size.y(), size.z()});
  Eigen::Vector3f p = UnitPlace(frame, position);
  if (lies && size.x() >= size.y()) p = Eigen::Vector3f(p.y(), p.z(), p.x());
  if (lies && size.y() > size.x()) p = Eigen::Vector3f(p.z(), p.x(), p.y());
  FruitPlace place;
  place.along = std::clamp(p.z(), -1.0f, 1.0f);
  place.direction = p.normalized();
  return place;
}

// Meridian streaks, closed around the axis: noise on the circle, stretched along it.
float Streaks(const FruitPlace& place, float count, float stretch, std::uint32_t seed) {
  const Eigen::Vector2f circle = place.direction.head<2>().stableNormalized();
  const Eigen::Vector3f p(count * circle.x(), count * circle.y(), stretch * place.along);
  return FractalNoise(p, 3, 0.0f, seed, 0.6f);
}

// Small spots, one per cell; returns their share.
float Spots(const Eigen::Vector3f& p, float cell, float largest, float footprint,
            std::uint32_t seed) {
  const CellPoint spot = CellNoise(p / cell, seed);
  const float radius = largest * (0.3f + 0.7f * HashUniform(spot.id, 5));
  return (1.0f - SmoothStep(0.5f * radius, radius, spot.nearest)) *
         Visible(2.0f * radius * cell, footprint);
}

}  // namespace

MaterialSample SkinAt(const SurfaceMaterial& m, const PartFrame& frame,
                      const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + frame.seed + 89u;
  const FruitPlace place = InFruit(frame, point.position);
  const Eigen::Vector3f& p = point.position;
  const float size = std::max(0.01f, frame.box.sizes().minCoeff());
  const float cloud = FractalNoise(2.2f * place.direction, 4, 0.0f, seed);
  const float ends = SmoothStep(0.72f, 1.0f, std::abs(place.along) + 0.06f * cloud);
  MaterialSample sample;
  sample.color = m.color * (1.0f + 0.07f * cloud);
  sample.roughness = m.roughness + 0.05f * cloud;
  switch (m.figure) {
    case SkinFigure::kStreaks: {  // an apple: blush on one side, streaks, pale dots
      const std::uint32_t h = CellHash(3, 1, 4, seed);
      const float angle = 6.2831853f * HashUniform(h, 0);
      const float side =
          place.direction.x() * std::cos(angle) + place.direction.y() * std::sin(angle);
      const float fine = Streaks(place, 22.0f, 1.4f, seed + 1);
      const float broad = Streaks(place, 7.0f, 0.9f, seed + 2);
      const float blush = 0.55f + 0.42f * side + 0.22f * fine + 0.20f * broad + 0.30f * cloud -
                          0.55f * ends * m.strength;
      const float flecks = 0.16f * SmoothStep(0.1f, 0.6f, Streaks(place, 60.0f, 2.5f, seed + 4));
      sample.color = Mix(m.second * (1.0f + 0.06f * cloud), m.color,
                         std::clamp(SmoothStep(-0.25f, 0.75f, blush) + flecks, 0.0f, 1.0f));
      sample.color *= 1.0f + 0.10f * fine;
      const float dots = Spots(p, 0.085f * size, 0.09f, point.footprint, seed + 3);
      sample.color = Mix(sample.color, Eigen::Vector3f(0.90f, 0.82f, 0.62f), 0.55f * dots);
      break;
    }
    case SkinFigure::kPores: {  // citrus: pits, deeper in colour
      const float cell = std::max(0.028f * size, 3.0f * point.footprint);
      const CellPoint pit = CellNoise(p / cell, seed + 1);
      const float dent = 1.0f - SmoothStep(0.12f, 0.42f, pit.nearest);
      sample.color = Mix(sample.color, m.second, 0.18f + 0.35f * dent * m.strength);
      const float tip = SmoothStep(0.972f, 0.995f, place.along);
      sample.color = Mix(sample.color, Eigen::Vector3f(0.42f, 0.44f, 0.20f), 0.7f * tip);
      sample.roughness += 0.08f * dent;
      sample.height = -0.10f * cell * dent;
      break;
    }
    case SkinFigure::kSpots: {  // bananas, pears: freckles and ends of another colour
      const float freckles = Spots(p, 0.11f * size, 0.16f, point.footprint, seed + 1);
      const float patches =
          SmoothStep(0.38f, 0.75f, FractalNoise(6.0f * place.direction, 4, 0.0f, seed + 2));
      sample.color = Mix(sample.color, m.second, 0.55f * ends);
      sample.color = Mix(sample.color, 0.45f * m.second + Eigen::Vector3f(0.10f, 0.05f, 0.0f),
                         m.strength * std::clamp(0.6f * freckles + 0.5f * patches, 0.0f, 1.0f));
      break;
    }
    case SkinFigure::kBands: {  // melons, cucumbers: ragged stripes along the axis
      const Eigen::Vector2f circle = place.direction.head<2>().stableNormalized();
      const float ragged = 0.32f * FractalNoise(9.0f * place.direction, 3, 0.0f, seed + 1);
      const float angle = std::atan2(circle.y(), circle.x()) + ragged;
      const float band = 0.5f + 0.5f * std::sin(11.0f * angle);
      const float veins = FractalNoise(20.0f * place.direction, 3, 0.0f, seed + 2);
      sample.color = Mix(m.color, m.second, SmoothStep(0.35f, 0.7f, band + 0.18f * veins));
      sample.color *= 1.0f + 0.05f * cloud;
      break;
    }
    case SkinFigure::kFuzz: {  // kiwis, peaches, potatoes: fine fuzz and earth
      const float fuzz =
          FractalNoise(p / std::max(0.0012f, 2.0f * point.footprint), 3, 0.0f, seed + 1, 0.7f);
      const float eyes = Spots(p, 0.30f * size, 0.10f, point.footprint, seed + 2);
      const float blush = SmoothStep(-0.1f, 0.7f, place.direction.x() + 0.5f * cloud);
      sample.color = Mix(sample.color, m.second, 0.5f * blush) * (1.0f + 0.12f * fuzz);
      sample.color = Mix(sample.color, 0.6f * m.second, 0.4f * m.strength * eyes);
      sample.height = 6e-5f * fuzz;
      break;
    }
    case SkinFigure::kPlain: {
      sample.color =
          Mix(sample.color, m.second, 0.5f * ends + 0.12f * SmoothStep(0.2f, 0.7f, cloud));
      break;
    }
  }
  return sample;
}

MaterialSample CrustAt(const SurfaceMaterial& m, const PartFrame& frame,
                       const MaterialPoint& point) {
  const std::uint32_t seed = m.seed * 7919u + 97u;
  const Eigen::Vector3f& p = point.position;
  const float size = std::max(0.02f, frame.box.sizes().maxCoeff());
  const float cloud = FractalNoise(4.0f * p / size, 5, 4.0f * point.footprint / size, seed, 0.6f);
  const float grain = FractalNoise(p / 0.0016f, 3, point.footprint / 0.0016f, seed + 1, 0.6f);
  // Baked from above: brown on top, pale at the sides, brown again below.
  const float baked = SmoothStep(-0.2f, 0.9f, point.normal.z() + 0.6f * cloud) +
                      0.6f * SmoothStep(0.6f, 1.0f, -point.normal.z());
  const float flour =
      SmoothStep(0.25f, 0.7f, FractalNoise(p / 0.012f, 4, point.footprint / 0.012f, seed + 2));
  MaterialSample sample;
  sample.color = Mix(m.color, m.second, std::clamp(baked, 0.0f, 1.0f)) * (1.0f + 0.10f * grain);
  sample.color =
      Mix(sample.color, Eigen::Vector3f(0.93f, 0.88f, 0.78f), 0.25f * m.strength * flour);
  sample.roughness = m.roughness;
  sample.height = 1.5e-4f * grain + 2e-4f * cloud;
  return sample;
}

}  // namespace simwright::texture
