#pragma once

#include <cstdint>
#include <functional>

#include "core/progress.h"
#include "rl/wilson_interval.h"

namespace simwright::transfer {

// Returns true if a trial succeeds in world `index` at a scale of the uncertainty. Thread-safe, and
// a pure function of both.
using WorldTrial = std::function<bool(double scale, std::uint64_t index)>;

struct TransferRate {
  int worlds = 0, successes = 0;
  rl::Interval interval;  // 95 %, Wilson

  double rate() const { return worlds > 0 ? static_cast<double>(successes) / worlds : 0.0; }
};

// Tries worlds 0 to `worlds` - 1, in parallel. Advances `progress`, if any, by each.
TransferRate RateAt(const WorldTrial& trial, double scale, int worlds,
                    core::Progress* progress = nullptr);

// Returns the largest scale in [0, 4], within 1/16 of it or 1/16, at which the trial succeeds in
// at least `share` of the worlds, by bisection, for a rate that falls with the scale; -1 if it does
// not at scale 0 either. `at_one`: the rate at scale 1, which is known. Worlds that cannot change
// the answer are not tried.
double LargestScale(const WorldTrial& trial, const TransferRate& at_one, double share,
                    core::Progress* progress = nullptr);

}  // namespace simwright::transfer
