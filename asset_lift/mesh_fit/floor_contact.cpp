#include "asset_lift/mesh_fit/floor_contact.h"

namespace simwright::asset_lift {
namespace {

constexpr double kDown = -0.7;  // of the normal's height, from which on a face looks down

}  // namespace

bool StandOnFloor(double band, core::TriangleMesh* mesh) {
  bool moved = false;
  const auto put = [&](Eigen::Vector3d* vertex) {
    moved = moved || vertex->z() != 0.0;
    vertex->z() = 0.0;
  };
  for (Eigen::Vector3d& vertex : mesh->vertices) {
    if (vertex.z() < 0.0) put(&vertex);
  }
  for (const Eigen::Vector3i& t : mesh->triangles) {
    const Eigen::Vector3d &a = mesh->vertices[t[0]], &b = mesh->vertices[t[1]],
                          &c = mesh->vertices[t[2]];
    const Eigen::Vector3d across = (b - a).cross(c - a);
    if (across.z() > kDown * across.norm() || (a + b + c).z() > 3.0 * band) continue;
    for (int k = 0; k < 3; ++k) put(&mesh->vertices[t[k]]);
  }
  return moved;
}

}  // namespace simwright::asset_lift
