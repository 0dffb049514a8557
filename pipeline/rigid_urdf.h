#pragma once

#include "assets/urdf_reader.h"
#include "core/mesh.h"

namespace simwright::pipeline {

// What is seen of a URDF (of a link without visuals: what collides), all joints at zero, in the
// root's frame and the file's units: meshes keep the textures and materials of their files; a
// colour that the URDF gives takes the place of a mesh's own. Throws core::Error where no link has
// a shape.
core::TexturedMesh RigidVisual(const assets::UrdfModel& model, core::Findings* findings);

// The mass of all links, kg; 0 where a link with shapes has no inertial.
double StatedMass(const assets::UrdfModel& model);

}  // namespace simwright::pipeline
