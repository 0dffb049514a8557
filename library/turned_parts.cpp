#include "library/turned_parts.h"

#include <cmath>
#include <numbers>

#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

Eigen::Vector3d At(const ProfilePoint& ring, double angle) {
  return {ring.r * std::cos(angle), ring.r * std::sin(angle), ring.z};
}

}  // namespace

core::TriangleMesh TurnedPart(const std::vector<ProfilePoint>& rings, int corners, int foot) {
  std::vector<Eigen::Vector3d> points;
  for (size_t i = 0; i < rings.size(); ++i) {
    const int count = rings[i].r <= 0.0 ? 1 : i == 0 && foot > 0 ? foot : corners;
    for (int k = 0; k < count; ++k) {
      points.push_back(At(rings[i], 2.0 * std::numbers::pi * k / count));
    }
  }
  return Hull(points);
}

std::vector<core::TriangleMesh> WallParts(const std::vector<ProfilePoint>& outer,
                                          const std::vector<ProfilePoint>& inner, int count) {
  std::vector<core::TriangleMesh> parts;
  const double step = 2.0 * std::numbers::pi / count;
  for (int k = 0; k < count; ++k) {
    std::vector<Eigen::Vector3d> points;
    for (const ProfilePoint& ring : outer) {
      for (const double share : {0.0, 0.5, 1.0}) points.push_back(At(ring, (k + share) * step));
    }
    for (const ProfilePoint& ring : inner) {
      for (const double share : {0.0, 1.0}) points.push_back(At(ring, (k + share) * step));
    }
    parts.push_back(Hull(points));
  }
  return parts;
}

}  // namespace simwright::library
