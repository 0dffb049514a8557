#pragma once

#include <compare>
#include <set>
#include <vector>

#include "tasks/scene_state.h"

namespace simwright::tasks {

enum class FactKind {
  kJointAway,    // thing's joint `part` is open, on
  kJointAtRest,  // closed, off
  kHandEmpty,
  kHolding,  // thing
  kOnFloor,  // thing
  kOn,       // thing stands on `other`
  kIn,       // thing is in cavity `part` of `other`
  kFree,     // nothing stands on thing
  kAtGoal,   // thing was put where it was wanted
  kPushed,   // thing was pushed there
  kPoured,   // thing was tilted over `other`
};

// Something that is true or not, as rules reason about it.
struct Fact {
  FactKind kind = FactKind::kHandEmpty;
  int thing = -1, other = -1, part = -1;
  auto operator<=>(const Fact&) const = default;
};

using Facts = std::set<Fact>;

enum class Verb { kOpen, kClose, kPick, kPlaceOn, kPutInto, kPutDown, kPush, kPour };

// What a hand can do, and what it changes: STRIPS (Fikes and Nilsson, 1971).
struct Operator {
  Verb verb = Verb::kPick;
  int thing = -1;            // that is handled
  int other = -1;            // that it goes onto, into, over
  int part = -1;             // joint, or cavity of `other`
  std::vector<Fact> given;   // have to hold already: nothing is done to bring them about
  std::vector<Fact> wanted;  // are brought about first, in this order
  std::vector<Fact> adds, removes;
};

// The operators on the given things: joints that a hand can move, things that one hand can lift,
// flat tops, rooms that the thing fits.
std::vector<Operator> OperatorsFor(const SceneModel& model, const std::vector<int>& things);

// Operators that make `goals` true one after the other from `facts` on, by means and ends: what is
// wanted for a step is brought about before it. Empty where there is no way, or none within 12
// steps. `facts` becomes what holds at the end.
std::vector<Operator> Plan(const std::vector<Operator>& operators, const std::vector<Fact>& goals,
                           Facts* facts);

}  // namespace simwright::tasks
