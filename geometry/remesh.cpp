#include "geometry/remesh.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "geometry/surface_mesh.h"
#include "geometry/weld.h"

namespace simwright::geometry {

core::TriangleMesh RemeshIsotropic(const core::TriangleMesh& mesh, const RemeshOptions& options) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  if (!(options.edge_length > 0.0)) {
    throw core::Error("the edge length must be positive", "remeshing");
  }
  const core::TriangleMesh welded = Weld(mesh, 0.0);
  if (welded.empty()) throw core::Error("the mesh has no faces", "remeshing");
  // An equilateral triangle of edge l has the area sqrt(3) / 4 l^2.
  const double faces = core::SurfaceArea(welded) / (0.433 * std::pow(options.edge_length, 2));
  if (faces > 20e6) {
    throw core::Error("the edge length would make over 20 million faces", "remeshing",
                      "use a longer edge");
  }
  std::vector<Kernel::Point_3> points;
  for (const Eigen::Vector3d& v : welded.vertices) points.emplace_back(v.x(), v.y(), v.z());
  std::vector<std::array<std::size_t, 3>> polygons;
  for (const Eigen::Vector3i& t : welded.triangles) {
    polygons.push_back({static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                        static_cast<std::size_t>(t[2])});
  }
  if (!pmp::is_polygon_soup_a_polygon_mesh(polygons)) {
    throw core::Error("the mesh is not manifold or not oriented", "remeshing",
                      "make a solid of it first");
  }
  Mesh surface;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, surface);
  auto fixed = surface.add_property_map<Mesh::Edge_index, bool>("e:fixed", false).first;
  pmp::detect_sharp_edges(surface, options.feature_angle_deg, fixed);
  for (const auto e : surface.edges()) {
    if (surface.is_border(e)) fixed[e] = true;
  }
  // Split constrained edges to length first: the remesher must not touch them.
  std::vector<Mesh::Edge_index> long_edges;
  for (const auto e : surface.edges()) {
    if (fixed[e]) long_edges.push_back(e);
  }
  pmp::split_long_edges(long_edges, options.edge_length, surface,
                        CGAL::parameters::edge_is_constrained_map(fixed));
  pmp::isotropic_remeshing(surface.faces(), options.edge_length, surface,
                           CGAL::parameters::number_of_iterations(options.iterations)
                               .edge_is_constrained_map(fixed)
                               .protect_constraints(true));
  surface.collect_garbage();
  return FromSurfaceMesh(surface);
}

}  // namespace simwright::geometry
