#include "asset_lift/mesh_fit/area_penalty.h"

namespace simwright::asset_lift {

double AddAreaPenalty(const core::TriangleMesh& mesh, double unit, double weight,
                      std::vector<Eigen::Vector3d>* gradient) {
  const double share = 1.0 / (unit * unit);
  double area = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]],
                          &c = mesh.vertices[t[2]];
    const Eigen::Vector3d across = (b - a).cross(c - a);
    const double twice = across.norm();
    if (!(twice > 0.0)) continue;
    area += 0.5 * twice;
    const Eigen::Vector3d slope = (0.5 * share * weight / twice) * across;
    (*gradient)[t[0]] += (b - c).cross(slope);
    (*gradient)[t[1]] += (c - a).cross(slope);
    (*gradient)[t[2]] += (a - b).cross(slope);
  }
  return share * area;
}

}  // namespace simwright::asset_lift
