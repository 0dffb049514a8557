#pragma once

#include <map>
#include <string>
#include <vector>

#include "assets/world_writer.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

// The assets of exported scenes by category, which gives them their keys, folders and numbers.
using ExportedAssets = std::map<std::string, assets::WorldAsset>;

// Returns the objects of a scene as world objects, in their order, named by category and number:
// "cup_0", "cup_1". They point into `assets`. Throws core::Error, naming the category, if it has no
// asset.
std::vector<assets::WorldObject> WorldObjectsOf(const std::vector<SceneObject>& objects,
                                                const ExportedAssets& assets);

}  // namespace simwright::scene
