#include "asset_lift/priors/shape_parts.h"

#include <cmath>

#include "core/error.h"

namespace simwright::asset_lift {
namespace {

// Joins rings of `segments` vertices one to the next and closes both ends by a fan.
core::TriangleMesh JoinedRings(std::vector<Eigen::Vector3d> rings, int segments,
                               const Eigen::Vector3d& first, const Eigen::Vector3d& last) {
  core::TriangleMesh mesh;
  mesh.vertices = std::move(rings);
  const int count = static_cast<int>(mesh.vertices.size()) / segments;
  for (int r = 0; r + 1 < count; ++r) {
    for (int s = 0; s < segments; ++s) {
      const int a = r * segments + s, b = r * segments + (s + 1) % segments;
      mesh.triangles.push_back({a, b, b + segments});
      mesh.triangles.push_back({a, b + segments, a + segments});
    }
  }
  const int low = static_cast<int>(mesh.vertices.size()), high = low + 1;
  mesh.vertices.push_back(first);
  mesh.vertices.push_back(last);
  for (int s = 0; s < segments; ++s) {
    const int next = (s + 1) % segments;
    mesh.triangles.push_back({low, next, s});
    mesh.triangles.push_back({high, (count - 1) * segments + s, (count - 1) * segments + next});
  }
  return mesh;
}

double SignedPower(double base, double exponent) {
  return std::copysign(std::pow(std::abs(base), exponent), base);
}

}  // namespace

core::TriangleMesh BoxPart(const Eigen::Vector3d& size) {
  core::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        0.5 * size.cwiseProduct(Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

core::TriangleMesh RevolvedPart(const std::vector<Eigen::Vector2d>& profile, int segments) {
  if (profile.size() < 2 || segments < 3) {
    throw core::Error("a solid of revolution needs a profile");
  }
  std::vector<Eigen::Vector3d> rings;
  for (const Eigen::Vector2d& p : profile) {
    for (int s = 0; s < segments; ++s) {
      const double angle = 2.0 * M_PI * s / segments;
      rings.emplace_back(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y());
    }
  }
  return JoinedRings(std::move(rings), segments, {0, 0, profile.front().y()},
                     {0, 0, profile.back().y()});
}

core::TriangleMesh SuperquadricPart(const Eigen::Vector3d& half_size, double exponent_z,
                                    double exponent_xy, int segments) {
  std::vector<Eigen::Vector3d> rings;
  const int levels = segments / 2;
  for (int r = 1; r < levels; ++r) {
    const double latitude = M_PI * (static_cast<double>(r) / levels - 0.5);
    const double wide = SignedPower(std::cos(latitude), exponent_z);
    for (int s = 0; s < segments; ++s) {
      const double angle = 2.0 * M_PI * s / segments;
      rings.push_back(
          half_size.cwiseProduct(Eigen::Vector3d(wide * SignedPower(std::cos(angle), exponent_xy),
                                                 wide * SignedPower(std::sin(angle), exponent_xy),
                                                 SignedPower(std::sin(latitude), exponent_z))));
    }
  }
  return JoinedRings(std::move(rings), segments, {0, 0, -half_size.z()}, {0, 0, half_size.z()});
}

core::TriangleMesh TubePart(const std::vector<Eigen::Vector3d>& path, double radius, int segments) {
  if (path.size() < 2 || segments < 3) {
    throw core::Error("a tube needs a path of at least two points");
  }
  std::vector<Eigen::Vector3d> rings;
  Eigen::Vector3d side = (path[1] - path[0]).unitOrthogonal();
  for (size_t i = 0; i < path.size(); ++i) {
    const Eigen::Vector3d along =
        (path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0]).normalized();
    side = (side - side.dot(along) * along).normalized();  // parallel transport, without twist
    const Eigen::Vector3d up = along.cross(side);
    for (int s = 0; s < segments; ++s) {
      const double angle = 2.0 * M_PI * s / segments;
      rings.push_back(path[i] + radius * (std::cos(angle) * side + std::sin(angle) * up));
    }
  }
  return JoinedRings(std::move(rings), segments, path.front(), path.back());
}

}  // namespace simwright::asset_lift
