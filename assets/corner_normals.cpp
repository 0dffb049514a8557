#include "assets/corner_normals.h"

namespace simwright::assets {
namespace {

// A unit vector, or the z axis for one of no length.
Eigen::Vector3d UnitOrUp(const Eigen::Vector3d& vector) {
  const double length = vector.norm();
  return length > 0.0 ? Eigen::Vector3d(vector / length) : Eigen::Vector3d::UnitZ();
}

}  // namespace

std::vector<Eigen::Vector3d> CornerNormals(const core::TriangleMesh& mesh) {
  constexpr double kCosine = 0.766;
  constexpr size_t kMostFaces = 2048;
  std::vector<Eigen::Vector3d> areas, units;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    areas.push_back(core::TriangleAreaVector(mesh, static_cast<int>(t)));
    units.push_back(UnitOrUp(areas.back()));
  }
  std::vector<std::vector<int>> faces(mesh.vertices.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int vertex : mesh.triangles[t]) {
      faces[static_cast<size_t>(vertex)].push_back(static_cast<int>(t));
    }
  }
  std::vector<Eigen::Vector3d> normals;
  normals.reserve(3 * mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int vertex : mesh.triangles[t]) {
      const std::vector<int>& about = faces[static_cast<size_t>(vertex)];
      if (about.size() > kMostFaces) {
        normals.push_back(units[t]);
        continue;
      }
      Eigen::Vector3d sum = areas[t];
      for (const int other : about) {
        const auto o = static_cast<size_t>(other);
        if (o != t && units[o].dot(units[t]) > kCosine) sum += areas[o];
      }
      normals.push_back(sum.norm() > 0.0 ? UnitOrUp(sum) : units[t]);
    }
  }
  return normals;
}

}  // namespace simwright::assets
