#pragma once

namespace simwright::rl {

struct Interval {
  double low = 0.0;
  double high = 1.0;
};

// Returns Wilson's score interval (1927) of a success rate, given `successes` of `trials`; it keeps
// its level for rates near 0 and 1. `z`: the normal distribution's quantile, 1.96 for 95 %. [0, 1]
// without trials.
Interval WilsonInterval(int successes, int trials, double z = 1.959963984540054);

}  // namespace simwright::rl
