#include <algorithm>
#include <cmath>

#include "texture/materials/noise.h"
#include "texture/materials/substances.h"

namespace simwright::texture {
namespace {

constexpr float kTwoPi = 6.2831853f;

// Returns 1 inside |d| < half, 0 outside, over the width of a texel.
float Inside(float d, float half, float footprint) {
  const float soft = std::max(0.5f * footprint, 1e-6f);
  return 1.0f - SmoothStep(half - soft, half + soft, std::abs(d));
}

// Returns the distance (m) to the middle of the stripe of the period, the period made such that a
// whole number of them goes into `length` where that is known.
float StripeDistance(float place, float period, float length) {
  if (length > 0.0f) period = length / std::max(1.0f, std::round(length / period));
  return (place / period - std::floor(place / period) - 0.5f) * period;
}

float Circumference(const PartFrame& frame) {
  return frame.round ? 0.5f * kTwoPi * frame.box.sizes().head<2>().maxCoeff() : 0.0f;
}

float PatternShareAt(const SurfaceMaterial& m, const PartFrame& frame, const MaterialPoint& point) {
  const float size = std::max(m.pattern_size, 4.0f * point.footprint);
  const Eigen::Vector2f at = SurfacePlace(frame, point);
  const float around = std::abs(point.normal.z()) < 0.8f ? Circumference(frame) : 0.0f;
  switch (m.pattern) {
    case Pattern::kStripes: {
      // Bands about the vertical; upright stripes for every other seed.
      if (m.seed % 2 == 0 && around > 0.0f) {
        return Inside(StripeDistance(at.x(), 2 * size, around), 0.5f * size, point.footprint);
      }
      const float up = point.position.z() - frame.box.min().z();
      return Inside(StripeDistance(up, 2 * size, 0.0f), 0.5f * size, point.footprint);
    }
    case Pattern::kDots: {
      const float u = StripeDistance(at.x(), 2 * size, around);
      const float row = std::floor(at.y() / (2 * size));
      const float shift = static_cast<int>(row) % 2 == 0 ? 0.0f : size;
      const float x = around > 0.0f ? StripeDistance(at.x() + shift, 2 * size, around)
                                    : StripeDistance(at.x() + shift, 2 * size, 0.0f);
      const float y = StripeDistance(at.y(), 2 * size, 0.0f);
      static_cast<void>(u);
      return Inside(std::hypot(x, y), 0.5f * size, point.footprint);
    }
    case Pattern::kChecks: {
      const float a =
          Inside(StripeDistance(at.x(), 2 * size, around), 0.5f * size, point.footprint);
      const float b = Inside(StripeDistance(at.y(), 2 * size, 0.0f), 0.5f * size, point.footprint);
      return a + b - 2.0f * a * b;
    }
    case Pattern::kPlaid: {
      const float a =
          Inside(StripeDistance(at.x(), 2 * size, around), 0.5f * size, point.footprint);
      const float b = Inside(StripeDistance(at.y(), 2 * size, 0.0f), 0.5f * size, point.footprint);
      return 0.5f * (a + b);
    }
    case Pattern::kRim: {
      const float below = frame.box.max().z() - point.position.z();
      return Inside(below - 0.9f * size, 0.25f * size, point.footprint);
    }
    case Pattern::kNone:
      break;
  }
  return 0.0f;
}

}  // namespace

Eigen::Vector3f UnitPlace(const PartFrame& frame, const Eigen::Vector3f& position) {
  const Eigen::Vector3f half = (0.5f * frame.box.sizes()).cwiseMax(1e-6f);
  return (position - frame.box.center()).cwiseQuotient(half);
}

Eigen::Vector2f SurfacePlace(const PartFrame& frame, const MaterialPoint& point) {
  const Eigen::Vector3f p = point.position - frame.box.center();
  const Eigen::Vector3f n = point.normal.cwiseAbs();
  if (frame.round && n.z() < 0.8f) {
    const float radius = 0.5f * frame.box.sizes().head<2>().maxCoeff();
    return {radius * std::atan2(p.y(), p.x()), p.z()};
  }
  if (n.z() >= n.x() && n.z() >= n.y()) return {p.x(), p.y()};
  return n.x() >= n.y() ? Eigen::Vector2f(p.y(), p.z()) : Eigen::Vector2f(p.x(), p.z());
}

Eigen::Vector3f PatternedColor(const SurfaceMaterial& material, const PartFrame& frame,
                               const MaterialPoint& point) {
  if (material.pattern == Pattern::kNone) return material.color;
  return Mix(material.color, material.pattern_color, PatternShareAt(material, frame, point));
}

}  // namespace simwright::texture
