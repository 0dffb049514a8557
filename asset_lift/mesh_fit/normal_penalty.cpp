#include "asset_lift/mesh_fit/normal_penalty.h"

#include <cmath>

#include "geometry/weld.h"

namespace simwright::asset_lift {

NormalPenalty::NormalPenalty(const core::TriangleMesh& mesh, double crease_angle)
    : crease_(1.0 - std::cos(crease_angle)), triangles_(mesh.triangles) {
  const std::vector<geometry::EdgeUse> uses = geometry::SortedEdgeUses(mesh);
  for (std::size_t i = 0, end = 0; i < uses.size(); i = end) {
    for (end = i; end < uses.size() && uses[end].key == uses[i].key;) ++end;
    if (end - i == 2) pairs_.emplace_back(uses[i].triangle, uses[i + 1].triangle);
  }
}

double NormalPenalty::Add(const std::vector<Eigen::Vector3d>& vertices, double weight,
                          std::vector<Eigen::Vector3d>* gradient) const {
  if (pairs_.empty()) return 0.0;
  std::vector<Eigen::Vector3d> normals(triangles_.size()), of_area(triangles_.size());
  std::vector<double> lengths(triangles_.size());
  for (std::size_t f = 0; f < triangles_.size(); ++f) {
    const Eigen::Vector3i& t = triangles_[f];
    normals[f] = (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
    lengths[f] = normals[f].norm();
    if (lengths[f] > 0.0) normals[f] /= lengths[f];
    of_area[f].setZero();
  }
  double sum = 0.0;
  const double share = 1.0 / static_cast<double>(pairs_.size());
  for (const auto& [f, g] : pairs_) {
    if (!(lengths[f] > 0.0) || !(lengths[g] > 0.0)) continue;
    const double cosine = normals[f].dot(normals[g]);
    double slope = share;
    if (crease_ > 0.0) {
      const double kept = std::exp((cosine - 1.0) / crease_);
      sum += share * crease_ * (1.0 - kept);
      slope *= kept;
    } else {
      sum += share * (1.0 - cosine);
    }
    of_area[f] -= slope * (normals[g] - cosine * normals[f]) / lengths[f];
    of_area[g] -= slope * (normals[f] - cosine * normals[g]) / lengths[g];
  }
  for (std::size_t f = 0; f < triangles_.size(); ++f) {
    const Eigen::Vector3i& t = triangles_[f];
    const Eigen::Vector3d at1 = (vertices[t[2]] - vertices[t[0]]).cross(weight * of_area[f]);
    const Eigen::Vector3d at2 = (weight * of_area[f]).cross(vertices[t[1]] - vertices[t[0]]);
    (*gradient)[t[0]] -= at1 + at2;
    (*gradient)[t[1]] += at1;
    (*gradient)[t[2]] += at2;
  }
  return sum;
}

}  // namespace simwright::asset_lift
