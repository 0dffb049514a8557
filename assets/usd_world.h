#pragma once

#include <string>
#include <vector>

#include "assets/world_writer.h"

namespace simwright::assets {

// Returns the path of an asset's layer relative to the world's layer: "../assets/cup/cup.usda".
std::string UsdLayerOf(const WorldAsset& asset);

// Returns the world as a layer of OpenUSD: an assembly with a UsdPhysics scene, the floor z = 0 as
// a plane, and the objects as instanceable references of their assets' layers (UsdLayerOf), placed
// by translation and orientation (doubles). A welded object is no rigid body, which makes its
// shapes static. `name` is the world's. The displayed name of an object is its own; its category is
// that of the asset. Throws core::Error if two objects share a name, two assets a key, or a name is
// not a valid file name.
std::string WorldUsd(const std::string& name, const std::vector<WorldObject>& objects);

}  // namespace simwright::assets
