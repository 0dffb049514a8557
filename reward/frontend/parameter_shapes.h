#pragma once

#include <vector>

#include "reward/frontend/syntax.h"
#include "reward/reward_options.h"
#include "reward/reward_scene.h"

namespace simwright::reward {

// Completes options->parameter_shapes and flag_parameters for the tensor parameters of `entry`:
// guesses shapes from names and indices, then searches for the shapes with which the program
// compiles furthest without an error. Deterministic. If nothing fits, keeps the first guess, and
// compilation reports the error. Returns the parameters whose width the program does not determine,
// such as one that is only summed: any other width would do as well.
std::vector<const Parameter*> InferParameterShapes(const Module& module, const Function& entry,
                                                   const RewardScene* scene,
                                                   RewardOptions* options);

}  // namespace simwright::reward
