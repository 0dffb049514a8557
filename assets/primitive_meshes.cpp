#include "assets/primitive_meshes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

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

namespace {

struct Ring {
  double radius, z;
};

// Meshes the rings from top to bottom, closed by a point above the first and one below the last.
core::TriangleMesh RoundMesh(double top, const std::vector<Ring>& rings, double bottom,
                             int segments) {
  core::TriangleMesh mesh;
  mesh.vertices.emplace_back(0, 0, top);
  for (const Ring& ring : rings) {
    for (int i = 0; i < segments; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / segments;
      mesh.vertices.emplace_back(ring.radius * std::cos(angle), ring.radius * std::sin(angle),
                                 ring.z);
    }
  }
  mesh.vertices.emplace_back(0, 0, bottom);
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  const int count = static_cast<int>(rings.size());
  const auto at = [&](int ring, int i) { return 1 + ring * segments + i % segments; };
  for (int i = 0; i < segments; ++i) {
    mesh.triangles.emplace_back(0, at(0, i), at(0, i + 1));
    for (int ring = 0; ring + 1 < count; ++ring) {
      mesh.triangles.emplace_back(at(ring, i), at(ring + 1, i), at(ring + 1, i + 1));
      mesh.triangles.emplace_back(at(ring, i), at(ring + 1, i + 1), at(ring, i + 1));
    }
    mesh.triangles.emplace_back(last, at(count - 1, i + 1), at(count - 1, i));
  }
  return mesh;
}

}  // namespace

core::TriangleMesh SphereMesh(double radius, int segments) {
  if (!(radius > 0.0) || segments < 3) throw core::Error("a sphere needs a positive radius");
  const int parts = std::max(2, segments / 2);
  std::vector<Ring> rings;
  for (int ring = 1; ring < parts; ++ring) {
    const double polar = std::numbers::pi * ring / parts;
    rings.push_back({radius * std::sin(polar), radius * std::cos(polar)});
  }
  return RoundMesh(radius, rings, -radius, segments);
}

core::TriangleMesh CapsuleMesh(double radius, double length, int segments) {
  if (!(radius > 0.0) || !(length > 0.0) || segments < 3) {
    throw core::Error("a capsule needs a positive radius and length");
  }
  const int parts = std::max(1, segments / 4);  // of a quarter turn
  std::vector<Ring> rings;
  for (int ring = 1; ring <= parts; ++ring) {
    const double polar = 0.5 * std::numbers::pi * ring / parts;
    rings.push_back({radius * std::sin(polar), 0.5 * length + radius * std::cos(polar)});
  }
  for (int ring = parts; ring >= 1; --ring) {
    rings.push_back(
        {rings[static_cast<size_t>(ring - 1)].radius, -rings[static_cast<size_t>(ring - 1)].z});
  }
  return RoundMesh(0.5 * length + radius, rings, -0.5 * length - radius, segments);
}

}  // namespace simwright::assets
