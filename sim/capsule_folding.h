#pragma once

#include <vector>

#include "assets/urdf_reader.h"
#include "sim/rigid_body.h"

namespace simwright::sim {

// URDF has no capsule: files give a cylinder and a sphere of its radius at each of its ends, in any
// order. Adds `shapes` to the parts of `body`, each such three as one capsule, each sphere alone as
// a capsule without length, the rest as they are.
void AddShapes(const std::vector<assets::UrdfShape>& shapes, RigidBody* body);

}  // namespace simwright::sim
