#pragma once

#include "assets/urdf_reader.h"
#include "core/mesh.h"

namespace simwright::importers {

// Returns the visuals of a URDF (the collisions of a link without visuals) with all joints at zero,
// in the root's frame and the file's units. Meshes keep the textures and materials of their files;
// a colour in the URDF overrides a mesh's own. Throws core::Error if no link has a shape.
core::TexturedMesh RigidVisual(const assets::UrdfModel& model, core::Findings* findings);

// Returns the total mass of all links, kg; 0 if a link with shapes has no inertial.
double StatedMass(const assets::UrdfModel& model);

}  // namespace simwright::importers
