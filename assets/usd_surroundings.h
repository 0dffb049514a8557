#pragma once

#include <string>

#include "assets/usd_prim.h"

namespace simwright::assets {

// Returns the root prim of a world, an assembly, with what every world has: a UsdPhysics scene with
// gravity, and the floor z = 0 as a plane ("ground/plane") with its own friction.
UsdPrim UsdWorldRoot(const std::string& name);

// Returns names of which those of the prims of UsdWorldRoot are taken.
UsdNames UsdWorldNames();

// Returns the path of the floor's plane in a world's layer.
std::string UsdFloorPath(const UsdPrim& root);

}  // namespace simwright::assets
