#include "library/rigid/revolved_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "library/convex_shapes.h"

namespace simwright::library {
namespace {

Eigen::Vector3d At(const ProfilePoint& ring, double angle) {
  return {ring.r * std::cos(angle), ring.r * std::sin(angle), ring.z};
}

constexpr double kOffGround = 5e-4;  // m, clearance of a wall: the base alone bears the load

// Returns at most seven of the points, including the ends: a wedge then has 35 corners.
std::vector<ProfilePoint> Few(const std::vector<ProfilePoint>& points) {
  const size_t last = std::min<size_t>(points.size(), 7) - 1;
  std::vector<ProfilePoint> few;
  for (size_t i = 0; i <= last; ++i) few.push_back(points[i * (points.size() - 1) / last]);
  return few;
}

}  // namespace

core::TriangleMesh RevolvedHull(const std::vector<ProfilePoint>& rings, int corners, int foot) {
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

std::vector<core::TriangleMesh> VesselParts(const std::vector<ProfilePoint>& outer,
                                            double thickness, double floor, int count,
                                            int foot_corners) {
  // The profile of VesselProfile has the outside between its middle points, then the inside down to
  // the floor.
  const std::vector<ProfilePoint> profile = VesselProfile(outer, thickness, floor);
  const std::vector<ProfilePoint> inner(
      profile.begin() + static_cast<std::ptrdiff_t>(outer.size()) + 1, profile.end() - 1);
  std::vector<ProfilePoint> wall = Few(outer);
  const ProfilePoint foot = wall[0], edge = inner.back();
  const double share = std::min(0.5, kOffGround / (wall[1].z - foot.z));
  wall[0].r += share * (wall[1].r - foot.r);
  wall[0].z += share * (wall[1].z - foot.z);
  std::vector<core::TriangleMesh> parts = WallParts(wall, Few(inner), count);
  parts.push_back(RevolvedHull({foot, edge}, 2 * count, foot_corners));
  return parts;
}

std::vector<core::TriangleMesh> TubeParts(const core::TexturedMesh& tube, int count) {
  constexpr int kRound = 16, kEvery = 2;  // points per section of TaperedTube, and the stride a
                                          // hull takes
  const std::vector<Eigen::Vector3d>& vertices = tube.mesh.vertices;
  const int sections = static_cast<int>(vertices.size() - 2) / kRound;  // two are the ends' centres
  std::vector<core::TriangleMesh> parts;
  for (int part = 0; part < count; ++part) {
    std::vector<Eigen::Vector3d> points;
    const int first = part * (sections - 1) / count, last = (part + 1) * (sections - 1) / count;
    const int steps = std::min(7, last - first);
    for (int i = 0; i <= steps; ++i) {
      const int section = first + i * (last - first) / steps;
      for (int k = 0; k < kRound; k += kEvery) {
        points.push_back(vertices[static_cast<size_t>(section * kRound + k)]);
      }
    }
    parts.push_back(Hull(points));
  }
  return parts;
}

}  // namespace simwright::library
