#pragma once

#include <vector>

#include "assets/articulated_asset.h"

namespace tinyxml2 {
class XMLElement;
class XMLPrinter;
}  // namespace tinyxml2

namespace simwright::assets {

// ArticulatedAsset::excluded_pairs in each format; nothing where there are none.
// URDF and SDF: Drake's <drake:collision_filter_group>, one a link, inside the robot or model.
// Bullet and Gazebo make no contacts inside a model unless they are asked to, and pass over these.
void UrdfExclusions(tinyxml2::XMLPrinter* printer, const ArticulatedAsset& asset);
void SdfExclusions(tinyxml2::XMLPrinter* printer, const ArticulatedAsset& asset);
// MJCF: <contact><exclude>. MuJoCo makes no contacts between a parent and its child by itself, but
// does where the parent is held to the world.
void MjcfExclusions(tinyxml2::XMLPrinter* printer, const ArticulatedAsset& asset);

// Reads UrdfExclusions back: groups of one link each that ignore another such group.
std::vector<ExcludedPair> ExcludedPairsIn(const tinyxml2::XMLElement& robot);

}  // namespace simwright::assets
