#pragma once

#include <vector>

#include "tasks/reward/code.h"
#include "tasks/reward/elaborator.h"

namespace simwright::tasks::reward {

// Turns a graph into passes over columns of numbers: what is never used is left out, chains are
// fused, registers are reused. Throws Fault where it needs more memory than allowed.
Code GenerateCode(Elaborator& elaborator, const ElaboratedOutputs& outputs,
                  const RewardOptions& options);

}  // namespace simwright::tasks::reward
