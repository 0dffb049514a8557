#include "geometry/winding_number.h"

#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/progress.h"

namespace simwright::geometry {

using Eigen::Vector3d;

double WindingNumber(const Vector3d& point, const core::TriangleMesh& mesh,
                     const std::vector<int>& triangles) {
  double half_angles = 0.0;
  for (const int t : triangles) {
    const Vector3d a = mesh.vertices[mesh.triangles[t][0]] - point;
    const Vector3d b = mesh.vertices[mesh.triangles[t][1]] - point;
    const Vector3d c = mesh.vertices[mesh.triangles[t][2]] - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    half_angles += std::atan2(a.dot(b.cross(c)), denominator);
  }
  return half_angles / (2.0 * std::numbers::pi);
}

std::vector<int> EnclosingWinding(const core::TriangleMesh& mesh, const std::vector<int>& component,
                                  int count) {
  std::vector<std::vector<int>> triangles(count);
  std::vector<Eigen::AlignedBox3d> boxes(count);
  for (std::size_t t = 0; t < component.size(); ++t) {
    triangles[component[t]].push_back(static_cast<int>(t));
    for (int c = 0; c < 3; ++c) boxes[component[t]].extend(mesh.vertices[mesh.triangles[t][c]]);
  }
  std::vector<int> winding(count, 0);
  core::ParallelFor(count, [&](int inner) {
    core::CheckCancelled();
    const Vector3d& point = mesh.vertices[mesh.triangles[triangles[inner][0]][0]];
    for (int outer = 0; outer < count; ++outer) {
      if (outer == inner || !boxes[outer].contains(boxes[inner])) continue;
      winding[inner] += static_cast<int>(std::lround(WindingNumber(point, mesh, triangles[outer])));
    }
  });
  return winding;
}

}  // namespace simwright::geometry
