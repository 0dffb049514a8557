#pragma once

#include <vector>

#include "assets/urdf_reader.h"
#include "sim/rigid_body.h"

namespace simwright::sim {

// Adds `shapes` to the parts of `body`. URDF has no capsules; files use a cylinder with a sphere of
// its radius at each end, in any order. Each such triple is added as one capsule, each single
// sphere as a capsule without length, all other shapes unchanged.
void AddShapes(const std::vector<assets::UrdfShape>& shapes, RigidBody* body);

}  // namespace simwright::sim
