#pragma once

#include <string>
#include <vector>

#include "assets/asset.h"
#include "assets/usd_prim.h"

namespace simwright::assets {

// Makes the prim a rigid body with an inertial, in the prim's frame.
void SetUsdBody(const Inertial& inertial, UsdPrim* prim);

// Disables the contacts of a body with the prims of the paths `others`; does nothing if there are
// none.
void SetUsdFilteredPairs(const std::vector<std::string>& others, UsdPrim* body);

}  // namespace simwright::assets
