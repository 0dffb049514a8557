#pragma once

#include <vector>

#include <Eigen/Core>

#include "scene/projection.h"

namespace simwright::scene {

// Lowers what hangs in the air straight down, the lowest first, until it meets what is beneath it
// or the floor z = 0: what a model leaves a few centimetres too high would land hard, and topple.
// What meets nothing within `most` (m, >= 0) stays where it is, and so do fixed bodies. Convex
// parts meet where the tangents of their distances, bounds from below as it is convex along the way
// down, leave less than 0.01 mm; walls that are about a degree off the vertical or less hold
// nothing, so that what slides past one may end up to 0.02 `most` in it. Returns the shifts (N x 3)
// m. Throws core::Error for a body without parts, or numbers that are not finite.
std::vector<Eigen::Vector3d> LowerOntoSupports(const std::vector<ProjectedBody>& bodies,
                                               double most);

}  // namespace simwright::scene
