#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

// The points x with normal . x = offset; `normal` is a unit vector.
struct CutPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
  double offset = 0.0;  // m
};

// Splits `mesh` (closed, oriented outward) into connected bodies on both sides of the plane, each
// closed again by a cap. Vertices within `tolerance` (m) of the plane count as on it; faces within
// it are rebuilt with the cap. Returns nothing if one side of the plane is empty or the volumes of
// the pieces do not add up to the mesh's; the caller then tries another plane.
std::vector<core::TriangleMesh> SplitByPlane(const core::TriangleMesh& mesh, const CutPlane& plane,
                                             double tolerance);

// Splits a mesh into bodies that share no vertex. An inward surface (a void) stays with the body
// around it.
std::vector<core::TriangleMesh> ConnectedBodies(core::TriangleMesh mesh);

}  // namespace simwright::geometry
