#pragma once

#include "assets/urdf_reader.h"

namespace simwright::assets {

// Turns the meshes of a URDF's links whose files say that x or y points up (DAE, glTF) to z up, as
// Drake and Gazebo do with glTF and PyBullet with DAE. Authors who looked at their robot in RViz,
// MoveIt or Gazebo alone, which ignore a DAE's <up_axis>, may have meshes that are right as they
// lie: where the links' joints and collisions fit the meshes better unturned, they stay so. One
// decision for all DAE and one for all glTF of the file, each a finding.
void TurnMeshesUp(UrdfModel* model);

}  // namespace simwright::assets
