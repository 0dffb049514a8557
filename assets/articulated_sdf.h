#pragma once

#include <string>

#include "assets/articulated_asset.h"

namespace simwright::assets {

// The asset as SDF 1.9, with the numbers of ArticulatedUrdfText: a model of links that stand in
// their parents' frames, joints whose frames are their children's; what is fixed is held to the
// world.
std::string ArticulatedSdfText(const ArticulatedAsset& asset);

}  // namespace simwright::assets
