#include "geometry/hole_filling.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <exception>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/weld.h"

namespace simwright::geometry {
namespace {

using Eigen::Vector3d;
using HoleKernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// The number of open edges that lead from each vertex, and to which.
using EdgesFrom = std::unordered_map<int, std::vector<int>>;

// Takes an unused edge from `vertex`; returns its end, or -1.
int TakeEdgeFrom(int vertex, EdgesFrom* edges) {
  const auto found = edges->find(vertex);
  if (found == edges->end() || found->second.empty()) return -1;
  const int next = found->second.back();
  found->second.pop_back();
  return next;
}

// Walks from `start` until no edge leads on, and cuts off each part of the way that has closed.
void WalkLoops(int start, EdgesFrom* edges, std::vector<BoundaryLoop>* loops) {
  std::vector<int> way{start};
  std::unordered_map<int, std::size_t> place{{start, 0}};
  while (!way.empty()) {
    const int next = TakeEdgeFrom(way.back(), edges);
    if (next < 0) {
      place.erase(way.back());
      way.pop_back();  // a dead end
      continue;
    }
    const auto seen = place.find(next);
    if (seen == place.end()) {
      place.emplace(next, way.size());
      way.push_back(next);
      continue;
    }
    BoundaryLoop loop(way.begin() + static_cast<std::ptrdiff_t>(seen->second), way.end());
    for (std::size_t i = 1; i < loop.size(); ++i) place.erase(loop[i]);
    way.resize(seen->second + 1);
    if (loop.size() >= 3) loops->push_back(std::move(loop));
  }
}

using FlatVertex = CGAL::Triangulation_vertex_base_with_info_2<int, HoleKernel>;
using FlatFace = CGAL::Constrained_triangulation_face_base_2<
    HoleKernel, CGAL::Triangulation_face_base_with_info_2<int, HoleKernel>>;
using FlatTriangulation = CGAL::Constrained_Delaunay_triangulation_2<
    HoleKernel, CGAL::Triangulation_data_structure_2<FlatVertex, FlatFace>,
    CGAL::No_constraint_intersection_tag>;

// Sets the info of each face to the number of loops around it.
void CountLoopsAround(FlatTriangulation* flat) {
  for (const auto face : flat->all_face_handles()) face->info() = -1;
  std::vector<std::pair<FlatTriangulation::Face_handle, int>> pending{{flat->infinite_face(), 0}};
  // Faces across a constraint wait at the back until all on this side are done.
  std::vector<std::pair<FlatTriangulation::Face_handle, int>> beyond;
  while (!pending.empty()) {
    const auto [face, depth] = pending.back();
    pending.pop_back();
    if (face->info() < 0) {
      face->info() = depth;
      for (int k = 0; k < 3; ++k) {
        const auto neighbor = face->neighbor(k);
        if (neighbor->info() >= 0) continue;
        const bool crosses = face->is_constrained(k);
        (crosses ? beyond : pending).emplace_back(neighbor, depth + crosses);
      }
    }
    if (pending.empty()) pending.swap(beyond);
  }
}

}  // namespace

std::vector<BoundaryLoop> BoundaryLoops(const core::TriangleMesh& mesh) {
  const std::vector<EdgeUse> uses = SortedEdgeUses(mesh);
  EdgesFrom edges;
  std::vector<int> starts;
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i;
    while (end < uses.size() && uses[end].key == uses[i].key) ++end;
    if (end - i == 1) {
      int from = static_cast<int>(uses[i].key >> 32);
      int to = static_cast<int>(uses[i].key & 0xffffffffu);
      if (uses[i].forward) std::swap(from, to);  // a face beyond the edge uses it backward
      edges[from].push_back(to);
      starts.push_back(from);
    }
    i = end;
  }
  std::vector<BoundaryLoop> loops;
  for (const int start : starts) WalkLoops(start, &edges, &loops);
  return loops;
}

LoopShape ShapeOf(const std::vector<Vector3d>& vertices, const BoundaryLoop& loop) {
  LoopShape shape;
  Eigen::AlignedBox3d box;
  for (const int v : loop) {
    shape.center += vertices[v] / static_cast<double>(loop.size());
    box.extend(vertices[v]);
  }
  Vector3d twice = Vector3d::Zero();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector3d& a = vertices[loop[i]];
    const Vector3d& b = vertices[loop[(i + 1) % loop.size()]];
    twice += (a - shape.center).cross(b - shape.center);
    shape.perimeter += (b - a).norm();
  }
  shape.area = 0.5 * twice.norm();
  if (shape.area > 0.0) shape.normal = twice.normalized();
  shape.extent = box.diagonal().norm();
  for (const int v : loop) {
    shape.flatness =
        std::max(shape.flatness, std::abs(shape.normal.dot(vertices[v] - shape.center)));
  }
  return shape;
}

std::vector<Eigen::Vector3i> FillLoop(const std::vector<Vector3d>& vertices,
                                      const BoundaryLoop& loop) {
  if (loop.size() == 3) return {{loop[0], loop[1], loop[2]}};
  std::vector<HoleKernel::Point_3> polyline;
  for (const int v : loop) {
    polyline.emplace_back(vertices[v].x(), vertices[v].y(), vertices[v].z());
  }
  std::vector<CGAL::Triple<int, int, int>> faces;
  try {
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(polyline, std::back_inserter(faces));
  } catch (const std::exception&) {
    return {};
  }
  std::vector<Eigen::Vector3i> triangles;
  for (const auto& face : faces) {
    triangles.emplace_back(loop[static_cast<std::size_t>(face.first)],
                           loop[static_cast<std::size_t>(face.second)],
                           loop[static_cast<std::size_t>(face.third)]);
  }
  return triangles;
}

std::vector<Eigen::Vector3i> FillFlatLoops(const std::vector<Vector3d>& vertices,
                                           const std::vector<BoundaryLoop>& loops,
                                           const Vector3d& normal) {
  const Vector3d across = normal.unitOrthogonal();
  const Vector3d along = normal.cross(across);
  FlatTriangulation flat;
  try {
    for (const BoundaryLoop& loop : loops) {
      std::vector<FlatTriangulation::Vertex_handle> corners;
      for (const int v : loop) {
        corners.push_back(
            flat.insert(HoleKernel::Point_2(across.dot(vertices[v]), along.dot(vertices[v]))));
        corners.back()->info() = v;
      }
      for (std::size_t i = 0; i < corners.size(); ++i) {
        flat.insert_constraint(corners[i], corners[(i + 1) % corners.size()]);
      }
    }
  } catch (const std::exception&) {
    return {};
  }
  CountLoopsAround(&flat);
  std::vector<Eigen::Vector3i> triangles;
  for (const auto face : flat.finite_face_handles()) {
    if (face->info() % 2 == 0) continue;
    triangles.emplace_back(face->vertex(0)->info(), face->vertex(1)->info(),
                           face->vertex(2)->info());
  }
  return triangles;
}

}  // namespace simwright::geometry
