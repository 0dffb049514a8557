#pragma once

#include <cstddef>
#include <vector>

#include "scene/asset_set/asset_set.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

// The shape of a body in depth measurements.
enum class BodyShape {
  kParts,  // its convex collision parts
  kBox,    // the box of its parts along its own axes: fills hollow objects
};

// Returns the sum of the depths (m, >= 0) of all interpenetrating pairs of shapes of different
// objects, pairs of welded objects excluded: "total penetration" (Pfaff et al.), whose median over
// scenes is MTP. A depth is the shortest displacement that separates two convex shapes. Throws
// core::Error for a category without an asset, or a pose that is not finite.
double TotalPenetration(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                        BodyShape shape);

// Two objects that penetrate each other.
struct PenetratingPair {
  size_t a = 0, b = 0;  // a < b
  double depth = 0.0;   // m, of their deepest pair of convex parts
};

// Returns the pairs of objects whose parts penetrate by more than `depth` (m, >= 0), sorted, pairs
// of welded objects excluded. Throws as TotalPenetration does.
std::vector<PenetratingPair> PenetratingPairs(const std::vector<SceneObject>& objects,
                                              const AssetSet& asset_set, double depth);

}  // namespace simwright::scene
