#pragma once

#include <vector>

#include <Eigen/Core>

#include "scene/feasibility/depenetration.h"

namespace simwright::scene {

// Lowers floating bodies vertically, in ascending order of height, until they touch the body
// beneath or the floor z = 0: a body that a model leaves a few centimetres too high would land hard
// and topple. A body that touches nothing within `most` (m, >= 0) keeps its pose, and so do fixed
// bodies. The distance of two convex parts is convex along the downward path; its tangents bound it
// from below, and the parts touch when they leave less than 0.01 mm. Walls within about a degree of
// the vertical do not support, so that a body that slides past one may penetrate it by up to 0.02
// `most`. Returns the displacements (N x 3), m. Throws core::Error for a body without parts, or
// numbers that are not finite.
std::vector<Eigen::Vector3d> LowerOntoSupports(const std::vector<ProjectedBody>& bodies,
                                               double most);

}  // namespace simwright::scene
