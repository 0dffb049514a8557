#pragma once

#include <set>
#include <string>

#include "tasks/reward/reward_options.h"
#include "tasks/reward/reward_scene.h"
#include "tasks/reward/syntax.h"

namespace simwright::tasks::reward {

// The names of all functions that are called in the module, as f(...) or self.f(...).
std::set<std::string> CalledNames(const Module& module);

// Completes options->parameter_shapes for the tensors among the parameters of `entry`: guesses
// from names and indices, then tries what lets the program come furthest without an error.
// Deterministic; where nothing fits the first guess stays, and compiling says what is wrong.
void InferParameterShapes(const Module& module, const Function& entry, const RewardScene* scene,
                          RewardOptions* options);

}  // namespace simwright::tasks::reward
