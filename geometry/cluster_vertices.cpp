#include "geometry/cluster_vertices.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/error.h"
#include "geometry/weld.h"

namespace simwright::geometry {

using Eigen::Vector3d;

core::TriangleMesh ClusterVertices(const core::TriangleMesh& mesh, double cell) {
  core::RequireValid(mesh, "vertex clustering");
  if (!(cell > 0.0)) throw core::Error("the cell must be positive", "vertex clustering");
  const Vector3d low = core::Bounds(mesh).min();
  const auto key_of = [&](const Vector3d& p) {
    const Vector3d at = ((p - low) / cell).array().floor().min(2097151.0);
    return (static_cast<std::uint64_t>(at.x()) << 42) | (static_cast<std::uint64_t>(at.y()) << 21) |
           static_cast<std::uint64_t>(at.z());
  };
  std::vector<std::pair<std::uint64_t, int>> order(mesh.vertices.size());
  for (std::size_t v = 0; v < order.size(); ++v) {
    order[v] = {key_of(mesh.vertices[v]), static_cast<int>(v)};
  }
  std::sort(order.begin(), order.end());
  core::TriangleMesh clustered = mesh;
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first;
    Vector3d mean = Vector3d::Zero();
    for (; end < order.size() && order[end].first == order[first].first; ++end) {
      mean += mesh.vertices[order[end].second];
    }
    mean /= static_cast<double>(end - first);
    int nearest = order[first].second;
    for (std::size_t i = first; i < end; ++i) {
      if ((mesh.vertices[order[i].second] - mean).squaredNorm() <
          (mesh.vertices[nearest] - mean).squaredNorm()) {
        nearest = order[i].second;
      }
    }
    for (std::size_t i = first; i < end; ++i) {
      clustered.vertices[order[i].second] = mesh.vertices[nearest];
    }
    first = end;
  }
  return Weld(clustered, 0.0);
}

}  // namespace simwright::geometry
