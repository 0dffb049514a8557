#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

// A closed polyline along open edges, as indices of vertices, in the direction in which a face that
// closes it is wound.
using BoundaryLoop = std::vector<int>;

// Returns the loops of the edges that have one face. Each visits a vertex once. Open edges that
// form no loop, because neighbouring faces do not agree on their direction, are left out.
std::vector<BoundaryLoop> BoundaryLoops(const core::TriangleMesh& mesh);

struct LoopShape {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   // mean of the vertices
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, of the area that it spans
  double area = 0.0;       // in the mesh's unit squared, projected along `normal`
  double perimeter = 0.0;  // in the mesh's unit
  double extent = 0.0;     // diagonal of its AABB
  double flatness = 0.0;   // largest distance of a vertex from the plane through `center`
};
LoopShape ShapeOf(const std::vector<Eigen::Vector3d>& vertices, const BoundaryLoop& loop);

// Returns triangles that close the loop: those of the least dihedral angles and area (Liepa 2003).
// Empty if the loop cannot be closed by triangles between its vertices.
std::vector<Eigen::Vector3i> FillLoop(const std::vector<Eigen::Vector3d>& vertices,
                                      const BoundaryLoop& loop);

// Returns triangles that close loops of one plane together: what an odd number of them surrounds,
// so that a loop within another stays a hole of the filling (the ring on which a cup stands).
// `normal`: of the plane, unit; the triangles face along it. Empty if the loops intersect in its
// projection.
std::vector<Eigen::Vector3i> FillFlatLoops(const std::vector<Eigen::Vector3d>& vertices,
                                           const std::vector<BoundaryLoop>& loops,
                                           const Eigen::Vector3d& normal);

}  // namespace simwright::geometry
