#pragma once

#include <cstddef>

#include "core/mesh.h"

namespace simwright::geometry {

// Converts a CGAL::Surface_mesh (a template parameter, since no header here includes CGAL) of
// triangles without removed elements (collect_garbage) to a TriangleMesh with the same vertices and
// faces in the same order.
template <typename SurfaceMesh>
core::TriangleMesh FromSurfaceMesh(const SurfaceMesh& surface) {
  core::TriangleMesh mesh;
  mesh.vertices.reserve(surface.number_of_vertices());
  mesh.triangles.reserve(surface.number_of_faces());
  for (const auto v : surface.vertices()) {
    const auto& p = surface.point(v);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : surface.faces()) {
    Eigen::Vector3i corner;
    int c = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f))) {
      corner[c++] = static_cast<int>(static_cast<std::size_t>(v));
    }
    mesh.triangles.push_back(corner);
  }
  return mesh;
}

}  // namespace simwright::geometry
