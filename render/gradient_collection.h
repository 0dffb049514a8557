#pragma once

#include <vector>

#include "render/differentiable_surface.h"

namespace simwright::render {

// Gives `sums` the sizes of the objects; what is new is zero.
void FitSums(const std::vector<PreparedObject>& objects, GradientSums* sums);

// Adds the threads' sums to `gradients` (made to fit, and zero, where its sizes differ) in the
// threads' order, carries gradients of normals on to vertices, and sets the sums to zero.
void Collect(const std::vector<PreparedObject>& objects, const core::Camera& camera,
             bool smooth_normals, std::vector<GradientSums>* sums, SceneGradients* gradients);

}  // namespace simwright::render
