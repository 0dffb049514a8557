#pragma once

#include <compare>
#include <set>
#include <vector>

#include "tasks/world_state.h"

namespace simwright::tasks {

enum class PredicateKind {
  kJointAway,    // the object's joint `part` is open or on
  kJointAtRest,  // the joint is closed or off
  kGripperEmpty,
  kHolding,  // the gripper holds the object
  kOnFloor,  // the object is on the floor
  kOn,       // the object stands on `other`
  kIn,       // the object is in receptacle `part` of `other`
  kFree,     // nothing stands on the object
  kAtGoal,   // the object was put at its goal
  kPushed,   // the object was pushed to its goal
  kPoured,   // the object was tilted over `other`
};

// A ground predicate of the planner.
struct Predicate {
  PredicateKind kind = PredicateKind::kGripperEmpty;
  int object = -1, other = -1, part = -1;
  auto operator<=>(const Predicate&) const = default;
};

using PredicateSet = std::set<Predicate>;

enum class ActionType { kOpen, kClose, kPick, kPlaceOn, kPutInto, kPutDown, kPush, kPour };

// An action with its preconditions and effects: STRIPS (Fikes and Nilsson, 1971).
struct Operator {
  ActionType verb = ActionType::kPick;
  int object = -1;                // the object that is handled
  int other = -1;                 // the object that it goes onto, into or over
  int part = -1;                  // a joint, or a receptacle of `other`
  std::vector<Predicate> given;   // preconditions that must hold already; the planner does not
                                  // achieve them
  std::vector<Predicate> wanted;  // preconditions that the planner achieves first, in this order
  std::vector<Predicate> adds, removes;
};

// Returns the operators on the given objects: joints that the gripper can move, objects that it can
// lift, flat tops, and receptacles that the object fits.
std::vector<Operator> OperatorsFor(const WorldModel& model, const std::vector<int>& objects);

// Returns operators that achieve `goals` one after the other from `predicates`, by means-ends
// analysis: the preconditions of a step are achieved before it. Returns an empty plan if none
// exists within 12 steps. Updates `predicates` to the state after the plan.
std::vector<Operator> Plan(const std::vector<Operator>& operators,
                           const std::vector<Predicate>& goals, PredicateSet* predicates);

}  // namespace simwright::tasks
