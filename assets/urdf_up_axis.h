#pragma once

#include "assets/urdf_reader.h"

namespace simwright::assets {

// Rotates the meshes of a URDF's links whose files declare x or y as the up axis (DAE, glTF) to z
// up, as Drake and Gazebo do with glTF and PyBullet with DAE. Authors who checked their robot only
// in RViz, MoveIt or Gazebo, which ignore a DAE's <up_axis>, may have meshes that are correct
// unrotated: if the links' joints and collisions fit the unrotated meshes better, they are
// unchanged. There is one decision for all DAE files and one for all glTF files of the URDF, each
// reported as a finding.
void RotateMeshesToZUp(UrdfModel* model);

}  // namespace simwright::assets
