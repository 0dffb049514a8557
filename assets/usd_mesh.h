#pragma once

#include <string>
#include <vector>

#include "assets/usd_prim.h"
#include "core/mesh.h"

namespace simwright::assets {

// Returns the visual as a mesh without subdivision. `materials` are the paths of its materials'
// prims, by index; where the mesh has several, a subset of faces binds each that is used. Texture
// coordinates are the primvar "st". Requires a valid mesh (core::RequireValid) with faces.
UsdPrim UsdVisualMesh(const std::string& name, const core::TexturedMesh& visual,
                      const std::vector<std::string>& materials);

// Returns a convex part as a mesh that collides as its convex hull, is hidden from pictures
// (purpose "guide"), and has the physics material of the path `material`.
UsdPrim UsdCollisionMesh(const std::string& name, const core::TriangleMesh& part,
                         const std::string& material);

// Returns the points within `radius` of the segment from `a` to `b` (m) as a shape that collides: a
// capsule, or a sphere if a = b.
UsdPrim UsdCollisionCapsule(const std::string& name, const Eigen::Vector3d& a,
                            const Eigen::Vector3d& b, double radius, const std::string& material);

}  // namespace simwright::assets
