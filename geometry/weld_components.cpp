#include "geometry/weld_components.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include <exception>
#include <vector>

#include "core/progress.h"
#include "geometry/mesh_validity.h"
#include "geometry/surface_mesh.h"
#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using UnionKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using UnionMesh = CGAL::Surface_mesh<UnionKernel::Point_3>;

constexpr int kMostComponents = 64;

UnionMesh ToUnionMesh(const core::TriangleMesh& mesh) {
  UnionMesh surface;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    surface.add_vertex(UnionKernel::Point_3(v.x(), v.y(), v.z()));
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto vertex = [&](int k) {
      return UnionMesh::Vertex_index(static_cast<UnionMesh::size_type>(t[k]));
    };
    surface.add_face(vertex(0), vertex(1), vertex(2));
  }
  return surface;
}

}  // namespace

core::TriangleMesh UnionOfComponents(const core::TriangleMesh& mesh, int* count) {
  core::TriangleMesh oriented = mesh;
  OrientConsistently(&oriented);
  const std::vector<int> component = EdgeComponents(oriented, count);
  if (*count < 2 || *count > kMostComponents) return {};
  std::vector<core::TriangleMesh> parts(static_cast<std::size_t>(*count));
  for (std::size_t t = 0; t < component.size(); ++t) {
    parts[static_cast<std::size_t>(component[t])].triangles.push_back(oriented.triangles[t]);
  }
  for (core::TriangleMesh& part : parts) {
    part.vertices = oriented.vertices;
    part = WithoutUnusedVertices(part);
    if (!Examine(part, 1).IsSolid()) return {};
  }
  UnionMesh whole = ToUnionMesh(parts[0]);
  try {
    for (std::size_t p = 1; p < parts.size(); ++p) {
      core::CheckCancelled();
      UnionMesh part = ToUnionMesh(parts[p]);
      if (!CGAL::Polygon_mesh_processing::corefine_and_compute_union(whole, part, whole)) return {};
    }
  } catch (const CGAL::Failure_exception&) {
    return {};
  }
  if (whole.has_garbage()) whole.collect_garbage();
  core::TriangleMesh result = Weld(FromSurfaceMesh(whole), 0.0);
  return Examine(result, 1).IsSolid() ? result : core::TriangleMesh{};
}

}  // namespace simwright::geometry
