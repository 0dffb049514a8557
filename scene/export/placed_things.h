#pragma once

#include <map>
#include <string>
#include <vector>

#include "assets/world_writer.h"
#include "scene/grammar/scene_draw.h"

namespace simwright::scene {

// The assets of exported scenes by slot: what keys, folders and numbers the files get.
using ExportedAssets = std::map<std::string, assets::WorldAsset>;

// The objects of a scene as things of a world, in their order, named by slot and number: "cup_0",
// "cup_1". They point into `assets`. Throws core::Error, naming the slot, where it has no asset.
std::vector<assets::WorldThing> ThingsOf(const std::vector<DrawnObject>& objects,
                                         const ExportedAssets& assets);

}  // namespace simwright::scene
