#pragma once

#include <string>

#include "assets/articulated_asset.h"

namespace simwright::assets {

// Returns the asset as SDF 1.9, with the numbers of ArticulatedUrdfText: a model whose links have
// poses in their parents' frames, with joint frames at their children. A fixed asset is attached to
// the world by a fixed joint.
std::string ArticulatedSdfText(const ArticulatedAsset& asset);

}  // namespace simwright::assets
