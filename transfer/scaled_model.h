#pragma once

#include "assets/semantic_model.h"
#include "manipulation/grasp.h"

namespace simwright::transfer {

// Returns the model with all lengths times `factor` (> 0) about the root's origin and the same
// densities: masses grow with its third power, inertias with its fifth. Visual shapes are left out.
assets::SemanticModel ScaledModel(const assets::SemanticModel& model, double factor);

// Returns a grasp of the scaled object.
manipulation::Grasp ScaledGrasp(const manipulation::Grasp& grasp, double factor);

}  // namespace simwright::transfer
