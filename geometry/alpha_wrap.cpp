#include "geometry/alpha_wrap.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <array>
#include <exception>
#include <vector>

#include "core/error.h"
#include "geometry/surface_mesh.h"
#include "geometry/weld.h"

namespace simwright::geometry {

core::TriangleMesh AlphaWrap(const core::TriangleMesh& mesh, const AlphaWrapOptions& options) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const core::TriangleMesh welded = Weld(mesh, 0.0);
  if (welded.empty()) throw core::Error("the mesh has no faces", "alpha wrap");
  const Eigen::AlignedBox3d bounds = core::Bounds(welded);
  const double diagonal = bounds.diagonal().norm();
  if (!(diagonal > 0.0)) throw core::Error("the mesh has no extent", "alpha wrap");
  if (!(options.alpha_ratio > 0.0) || !(options.offset_ratio > 0.0)) {
    throw core::Error("alpha and offset must be positive", "alpha wrap");
  }
  std::vector<Kernel::Point_3> points;
  for (const Eigen::Vector3d& v : welded.vertices) {
    const Eigen::Vector3d p = (v - bounds.center()) / diagonal;
    points.emplace_back(p.x(), p.y(), p.z());
  }
  std::vector<std::array<std::size_t, 3>> faces;
  for (const Eigen::Vector3i& t : welded.triangles) {
    faces.push_back({static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                     static_cast<std::size_t>(t[2])});
  }
  CGAL::Surface_mesh<Kernel::Point_3> wrap;
  try {
    CGAL::alpha_wrap_3(points, faces, options.alpha_ratio, options.offset_ratio, wrap);
  } catch (const std::exception& e) {
    throw core::Error(std::string("alpha wrapping failed: ") + e.what(), "alpha wrap");
  }
  if (wrap.has_garbage()) wrap.collect_garbage();
  core::TriangleMesh result = FromSurfaceMesh(wrap);
  for (Eigen::Vector3d& v : result.vertices) v = bounds.center() + diagonal * v;
  return result;
}

}  // namespace simwright::geometry
