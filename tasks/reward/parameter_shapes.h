#pragma once

#include <vector>

#include "tasks/reward/reward_options.h"
#include "tasks/reward/reward_scene.h"
#include "tasks/reward/syntax.h"

namespace simwright::tasks::reward {

// Completes options->parameter_shapes and flag_parameters for the tensors among the parameters of
// `entry`: guesses from names and indices, then tries what lets the program come furthest without
// an error. Deterministic; where nothing fits the first guess stays, and compiling says what is
// wrong. Gives the parameters whose width nothing in the program says, such as one that is only
// summed: any other would do as well.
std::vector<const Parameter*> InferParameterShapes(const Module& module, const Function& entry,
                                                   const RewardScene* scene,
                                                   RewardOptions* options);

}  // namespace simwright::tasks::reward
