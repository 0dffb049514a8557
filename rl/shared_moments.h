#pragma once

#include "rl/communicator.h"
#include "rl/running_moments.h"

namespace simwright::rl {

// Returns the moments of the rows of both (Chan, Golub and LeVeque 1983).
RunningMoments Merged(const RunningMoments& first, const RunningMoments& second);

// Returns the moments of the rows of `all` that are not among those of `part`: the inverse of
// Merged.
RunningMoments Without(const RunningMoments& all, const RunningMoments& part);

// Returns the moments of the rows of `before`, which is equal on all ranks, and of those that each
// rank has added to it since: `now`. The result is equal on all ranks, for one rank it is `now`.
RunningMoments MergedOverRanks(const RunningMoments& before, const RunningMoments& now,
                               Communicator* ranks);

}  // namespace simwright::rl
