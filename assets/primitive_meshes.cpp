#include "assets/primitive_meshes.h"

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace simwright::assets {

core::TriangleMesh BoxMesh(const Eigen::Vector3d& size) {
  if (!(size.minCoeff() > 0.0)) throw core::Error("a box needs positive sides");
  core::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(0.5 * size.cwiseProduct(Eigen::Vector3d(
                                      i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0)));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

core::TriangleMesh CylinderMesh(double radius, double length, int segments) {
  if (!(radius > 0.0) || !(length > 0.0) || segments < 3) {
    throw core::Error("a cylinder needs a positive radius and length");
  }
  core::TriangleMesh mesh;
  mesh.vertices = {{0, 0, -0.5 * length}, {0, 0, 0.5 * length}};
  for (int i = 0; i < segments; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / segments;
    const double x = radius * std::cos(angle), y = radius * std::sin(angle);
    mesh.vertices.emplace_back(x, y, -0.5 * length);
    mesh.vertices.emplace_back(x, y, 0.5 * length);
  }
  for (int i = 0; i < segments; ++i) {
    const int a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % segments);
    mesh.triangles.emplace_back(0, b, a);
    mesh.triangles.emplace_back(1, a + 1, b + 1);
    mesh.triangles.emplace_back(a, b, a + 1);
    mesh.triangles.emplace_back(b, b + 1, a + 1);
  }
  return mesh;
}

core::TriangleMesh SphereMesh(double radius, int segments) {
  if (!(radius > 0.0) || segments < 3) throw core::Error("a sphere needs a positive radius");
  core::TriangleMesh mesh;
  const int rings = std::max(2, segments / 2);
  mesh.vertices.emplace_back(0, 0, radius);
  for (int ring = 1; ring < rings; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    for (int i = 0; i < segments; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / segments;
      mesh.vertices.emplace_back(radius * std::sin(polar) * std::cos(angle),
                                 radius * std::sin(polar) * std::sin(angle),
                                 radius * std::cos(polar));
    }
  }
  mesh.vertices.emplace_back(0, 0, -radius);
  const int bottom = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int ring, int i) { return 1 + (ring - 1) * segments + i % segments; };
  for (int i = 0; i < segments; ++i) {
    mesh.triangles.emplace_back(0, at(1, i), at(1, i + 1));
    for (int ring = 1; ring + 1 < rings; ++ring) {
      mesh.triangles.emplace_back(at(ring, i), at(ring + 1, i), at(ring + 1, i + 1));
      mesh.triangles.emplace_back(at(ring, i), at(ring + 1, i + 1), at(ring, i + 1));
    }
    mesh.triangles.emplace_back(bottom, at(rings - 1, i + 1), at(rings - 1, i));
  }
  return mesh;
}

}  // namespace simwright::assets
