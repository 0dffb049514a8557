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

// Both sides of `mesh` (closed, outward), each closed again by a cap in the plane, taken apart
// into connected bodies. Vertices within `tolerance` (m) of the plane count as on it, faces within
// it are made anew with the cap.
// Returns nothing where the plane leaves one side empty or where the volumes of the pieces do not
// add up to the mesh's: the caller takes another plane then.
std::vector<core::TriangleMesh> CutApart(const core::TriangleMesh& mesh, const CutPlane& plane,
                                         double tolerance);

// Bodies that share no vertex. An inward surface (a void) stays with the body round it.
std::vector<core::TriangleMesh> ConnectedBodies(const core::TriangleMesh& mesh);

}  // namespace simwright::geometry
