#pragma once

#include <vector>

#include "render/differentiable_surface.h"

namespace simwright::render {

// Resizes `sums` to fit the objects; new elements are zero.
void FitSums(const std::vector<PreparedObject>& objects, GradientSums* sums);

// Adds the threads' sums to `gradients` (resized and zeroed if its sizes differ) in thread order,
// propagates gradients of normals to vertices, and zeroes the sums.
void Collect(const std::vector<PreparedObject>& objects, const core::Camera& camera,
             bool smooth_normals, std::vector<GradientSums>* sums, SceneGradients* gradients);

}  // namespace simwright::render
