#pragma once

#include <vector>

#include "tasks/reward/code.h"
#include "tasks/reward/elaborator.h"

namespace simwright::tasks::reward {

// Compiles a graph into passes over columns of numbers: eliminates dead nodes, fuses operation
// chains and reuses registers. Throws Fault if the program needs more memory than allowed.
Code GenerateCode(Elaborator& elaborator, const ElaboratedOutputs& outputs,
                  const RewardOptions& options);

}  // namespace simwright::tasks::reward
