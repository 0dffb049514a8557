#pragma once

#include <vector>

#include "scene/grammar/scene_draw.h"
#include "scene/palette.h"

namespace simwright::scene {

// What a body is taken for where depths are measured.
enum class BodyShape {
  kParts,  // its convex parts, as physics has them
  kBox,    // the box of its parts along its own axes: hollow things are full
};

// Sum of the depths (m, >= 0) of all pairs of shapes of different objects that are in each other,
// welded ones not compared with welded ones: "total penetration" (Pfaff et al.), whose median over
// scenes is MTP. A depth is the shortest way out of two convex bodies. Throws core::Error for a
// slot without an asset, or a pose that is not finite.
double TotalPenetration(const std::vector<DrawnObject>& objects, const Palette& palette,
                        BodyShape shape);

}  // namespace simwright::scene
