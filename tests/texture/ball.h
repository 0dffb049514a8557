#pragma once

#include <cmath>

#include "core/mesh.h"

namespace simwright::texture {

// A ball of radius 1, of `rings` rings.
inline core::TriangleMesh Ball(int rings) {
  core::TriangleMesh mesh;
  mesh.vertices.emplace_back(0, 0, 1);
  const int around = 2 * rings;
  for (int r = 1; r < rings; ++r) {
    for (int k = 0; k < around; ++k) {
      const double a = M_PI * r / rings, b = 2 * M_PI * k / around;
      mesh.vertices.emplace_back(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
    }
  }
  mesh.vertices.emplace_back(0, 0, -1);
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int r, int k) { return 1 + (r - 1) * around + k % around; };
  for (int k = 0; k < around; ++k) {
    mesh.triangles.emplace_back(0, at(1, k), at(1, k + 1));
    for (int r = 1; r + 1 < rings; ++r) {
      mesh.triangles.emplace_back(at(r, k), at(r + 1, k), at(r + 1, k + 1));
      mesh.triangles.emplace_back(at(r, k), at(r + 1, k + 1), at(r, k + 1));
    }
    mesh.triangles.emplace_back(last, at(rings - 1, k + 1), at(rings - 1, k));
  }
  return mesh;
}

}  // namespace simwright::texture
