#pragma once

#include <vector>

#include "assets/articulated_asset.h"

namespace tinyxml2 {
class XMLElement;
class XMLPrinter;
}  // namespace tinyxml2

namespace simwright::assets {

// Write ArticulatedAsset::excluded_pairs, or nothing if there are none. URDF and SDF get Drake's
// <drake:collision_filter_group>, one per link, inside the robot or model. Bullet and Gazebo make
// no contacts inside a model by default and ignore these elements.
void UrdfExclusions(tinyxml2::XMLPrinter* printer, const ArticulatedAsset& asset);
void SdfExclusions(tinyxml2::XMLPrinter* printer, const ArticulatedAsset& asset);
// Writes MJCF's <contact><exclude>. MuJoCo disables contacts between a parent and its child by
// itself, except if the parent is fixed to the world.
void MjcfExclusions(tinyxml2::XMLPrinter* printer, const ArticulatedAsset& asset);

// Reads the output of UrdfExclusions: groups of one link each that ignore another such group.
std::vector<ExcludedPair> ExcludedPairsIn(const tinyxml2::XMLElement& robot);

}  // namespace simwright::assets
