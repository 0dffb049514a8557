#pragma once

#include <deque>

#include "rl/wilson_interval.h"

namespace simwright::rl {

// The outcome of an episode.
struct Outcome {
  double total_reward = 0.0;  // unscaled
  double steps = 0.0;
  bool success = false;
};

// The outcomes of the last `window` episodes.
class OutcomeWindow {
 public:
  explicit OutcomeWindow(int window) : window_(window) {}

  void Add(const Outcome& outcome);

  // Returns true if the window is full.
  bool full() const { return static_cast<int>(outcomes_.size()) == window_; }
  int successes() const { return successes_; }
  int size() const { return static_cast<int>(outcomes_.size()); }
  const std::deque<Outcome>& outcomes() const { return outcomes_; }

  // NaN without episodes.
  double MeanReward() const;
  double MeanSteps() const;
  double SuccessRate() const;
  Interval SuccessInterval() const { return WilsonInterval(successes_, size()); }

 private:
  int window_;
  int successes_ = 0;
  std::deque<Outcome> outcomes_;
};

}  // namespace simwright::rl
