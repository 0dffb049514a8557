#pragma once

#include "core/mesh.h"

namespace simwright::asset_lift {

// Makes an object stand on the floor z = 0: moves the vertices below the floor up to it, and those
// of the base down to it. The base are faces that look down and whose middle is less than `band`
// (m) above the floor. Returns true if a vertex moved.
bool StandOnFloor(double band, core::TriangleMesh* mesh);

}  // namespace simwright::asset_lift
