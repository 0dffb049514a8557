#pragma once

#include <cstdint>
#include <functional>

#include "rl/flat_parameters.h"
#include "rl/ppo_loss.h"

namespace simwright::rl {

// The means of PpoLoss's scalars over a minibatch; 0 for those that a loss does not define.
struct LossMeans {
  double policy = 0.0, value = 0.0, entropy = 0.0, kl = 0.0, clipped_share = 0.0;
};

// Computes the gradient of a minibatch's loss into parameters.gradients(), and returns its means.
// `loss_of(first, count)` returns the mean loss over rows [first, first + count) of `rows`. On a
// CPU, rows are split into shares of a fixed size, each on one thread: layers of this size are too
// short to split, and the gradient does not depend on the number of threads. On a GPU they stay
// together.
LossMeans BackpropagateInShares(
    const FlatParameters& parameters, std::int64_t rows,
    const std::function<PpoLoss(std::int64_t first, std::int64_t count)>& loss_of);

}  // namespace simwright::rl
