#include "rl/recent_outcomes.h"

namespace simwright::rl {
namespace {

template <typename Value>
double Mean(const std::deque<Outcome>& outcomes, const Value& value) {
  double sum = 0.0;
  for (const Outcome& outcome : outcomes) sum += value(outcome);
  return sum / static_cast<double>(outcomes.size());  // 0 / 0: NaN
}

}  // namespace

void OutcomeWindow::Add(const Outcome& outcome) {
  outcomes_.push_back(outcome);
  successes_ += outcome.success;
  if (size() <= window_) return;
  successes_ -= outcomes_.front().success;
  outcomes_.pop_front();
}

double OutcomeWindow::MeanReward() const {
  return Mean(outcomes_, [](const Outcome& outcome) { return outcome.total_reward; });
}

double OutcomeWindow::MeanSteps() const {
  return Mean(outcomes_, [](const Outcome& outcome) { return outcome.steps; });
}

double OutcomeWindow::SuccessRate() const {
  return Mean(outcomes_, [](const Outcome& outcome) { return outcome.success ? 1.0 : 0.0; });
}

}  // namespace simwright::rl
