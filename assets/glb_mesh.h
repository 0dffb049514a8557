#pragma once

#include <vector>

#include "assets/glb_buffer.h"
#include "assets/pbr_look.h"
#include "core/mesh.h"

namespace simwright::assets {

// Adds the visual as a mesh of one primitive per material, and its materials; returns the mesh's
// index. The mesh must have a face. Throws core::Error for a missing texture.
std::size_t AddGlbMesh(const std::string& name, const core::TexturedMesh& visual,
                       const PbrLook& look, GlbBuffer* glb);

// Returns the unit tangents of corners (3 M), along growing u, orthogonal to `normals` (3 M), and
// in w the sign of the bitangent: cross(normal, tangent) w. The tangents of faces are summed over
// the corners of equal position, normal and texture coordinates, weighted by their angles.
std::vector<Eigen::Vector4f> CornerTangents(const core::TexturedMesh& visual,
                                            const std::vector<Eigen::Vector3d>& normals);

}  // namespace simwright::assets
