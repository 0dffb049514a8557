#pragma once

#include <vector>

#include "reward/ir/code.h"
#include "reward/symbolic/elaborator.h"

namespace simwright::reward {

// Compiles a graph into passes over columns of numbers: eliminates dead nodes, fuses operation
// chains and reuses registers. Throws Fault if the program needs more memory than allowed.
Code GenerateCode(Elaborator& elaborator, const ElaboratedOutputs& outputs,
                  const RewardOptions& options);

}  // namespace simwright::reward
