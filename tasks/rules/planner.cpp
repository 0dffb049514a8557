#include "tasks/rules/planner.h"

#include <algorithm>

namespace simwright::tasks {
namespace {

constexpr std::size_t kMostSteps = 12;
constexpr int kDeepestPlan = 6;

class ForwardPlanner {
 public:
  ForwardPlanner(const std::vector<Operator>& operators, PredicateSet predicates)
      : operators_(operators), facts_(std::move(predicates)) {}

  bool Achieve(const Predicate& goal, int depth) {
    if (facts_.contains(goal)) return true;
    if (depth == kDeepestPlan) return false;
    for (const Operator& one : operators_) {
      if (std::find(one.adds.begin(), one.adds.end(), goal) == one.adds.end()) continue;
      const PredicateSet before = facts_;
      const std::size_t steps = steps_.size();
      if (Apply(one, depth)) return true;
      facts_ = before;
      steps_.resize(steps);
    }
    return false;
  }

  const PredicateSet& predicates() const { return facts_; }
  std::vector<Operator> Take() { return std::move(steps_); }

 private:
  bool Holds(const std::vector<Predicate>& predicates) const {
    return std::all_of(predicates.begin(), predicates.end(),
                       [&](const Predicate& predicate) { return facts_.contains(predicate); });
  }

  bool Apply(const Operator& one, int depth) {
    if (!Holds(one.given)) return false;
    for (const Predicate& predicate : one.wanted) {
      if (!Achieve(predicate, depth + 1)) return false;
    }
    // Achieving one precondition may have undone another.
    if (!Holds(one.given) || !Holds(one.wanted) || steps_.size() == kMostSteps) return false;
    for (const Predicate& predicate : one.removes) facts_.erase(predicate);
    for (const Predicate& predicate : one.adds) facts_.insert(predicate);
    steps_.push_back(one);
    return true;
  }

  const std::vector<Operator>& operators_;
  PredicateSet facts_;
  std::vector<Operator> steps_;
};

}  // namespace

std::vector<Operator> Plan(const std::vector<Operator>& operators,
                           const std::vector<Predicate>& goals, PredicateSet* predicates) {
  ForwardPlanner planner(operators, *predicates);
  for (const Predicate& goal : goals) {
    if (!planner.Achieve(goal, 0)) return {};
  }
  for (const Predicate& goal : goals) {
    if (!planner.predicates().contains(goal)) return {};
  }
  *predicates = planner.predicates();
  return planner.Take();
}

}  // namespace simwright::tasks
