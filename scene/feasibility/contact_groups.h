#pragma once

#include <vector>

#include "scene/asset_set/asset_set.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

// Returns a group per object: free objects that touch (parts closer than `touching`, m), directly
// or through other free objects, have the same one. Groups are numbered from 0 in the order of
// their first object; welded objects have -1. What happens in one group has no influence on the
// others. Throws core::Error for a category without an asset.
std::vector<int> ContactGroups(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                               double touching = 1e-3);

}  // namespace simwright::scene
