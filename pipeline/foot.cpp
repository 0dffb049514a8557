#include "pipeline/foot.h"

#include <cmath>
#include <numbers>
#include <set>

namespace simwright::pipeline {

std::vector<Eigen::Vector3d> FootCorners(const core::TriangleMesh& solid, int count) {
  const Eigen::AlignedBox3d box = core::Bounds(solid);
  const double level = box.min().z() + 1e-3 * box.sizes().z();
  std::vector<Eigen::Vector3d> low;
  for (const Eigen::Vector3d& vertex : solid.vertices) {
    if (vertex.z() <= level) low.push_back(vertex);
  }
  std::set<size_t> chosen;
  for (int i = 0; i < count && low.size() >= 3; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0.0);
    size_t best = 0;
    for (size_t v = 1; v < low.size(); ++v) {
      if (low[v].dot(direction) > low[best].dot(direction)) best = v;
    }
    chosen.insert(best);
  }
  std::vector<Eigen::Vector3d> corners;
  for (const size_t v : chosen) corners.push_back(low[v]);
  return corners;
}

}  // namespace simwright::pipeline
