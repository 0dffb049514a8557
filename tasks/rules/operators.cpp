#include "tasks/rules/affordances.h"
#include "tasks/rules/planner.h"

namespace simwright::tasks {
namespace {

const Fact kEmpty{FactKind::kHandEmpty};

Fact Of(FactKind kind, int thing, int other = -1, int part = -1) {
  return {kind, thing, other, part};
}

void AddJoints(const Thing& known, int thing, std::vector<Operator>* operators) {
  for (std::size_t j = 0; j < known.joints.size(); ++j) {
    const JointUse use = UseOf(known, known.joints[j]);
    if (use == JointUse::kNone) continue;
    const int joint = static_cast<int>(j);
    const Fact away = Of(FactKind::kJointAway, thing, -1, joint);
    const Fact rest = Of(FactKind::kJointAtRest, thing, -1, joint);
    operators->push_back({Verb::kOpen, thing, -1, joint, {rest}, {kEmpty}, {away}, {rest}});
    if (use == JointUse::kPress) continue;
    operators->push_back({Verb::kClose, thing, -1, joint, {away}, {kEmpty}, {rest}, {away}});
  }
}

// Adds operators that take an object from each possible place and put it down again.
void AddHandling(const SceneModel& model, int thing, const std::vector<int>& things,
                 std::vector<Operator>* operators) {
  const Fact held = Of(FactKind::kHolding, thing), floor = Of(FactKind::kOnFloor, thing);
  const Fact free = Of(FactKind::kFree, thing);
  operators->push_back(
      {Verb::kPick, thing, -1, -1, {floor, free}, {kEmpty}, {held}, {kEmpty, floor}});
  const Fact at_goal = Of(FactKind::kAtGoal, thing);
  operators->push_back(
      {Verb::kPutDown, thing, -1, -1, {}, {held}, {kEmpty, floor, at_goal}, {held}});
  const Thing& known = model.things[static_cast<std::size_t>(thing)];
  for (int other : things) {
    if (other == thing) continue;
    const Thing& holder = model.things[static_cast<std::size_t>(other)];
    if (StandsOn(known, holder)) {
      const Fact on = Of(FactKind::kOn, thing, other), bare = Of(FactKind::kFree, other);
      operators->push_back(
          {Verb::kPlaceOn, thing, other, -1, {bare}, {held}, {on, kEmpty}, {held, bare}});
      operators->push_back(
          {Verb::kPick, thing, other, -1, {on, free}, {kEmpty}, {held, bare}, {kEmpty, on}});
    }
    for (std::size_t c = 0; c < holder.cavities.size(); ++c) {
      const int cavity = static_cast<int>(c);
      if (!FitsInto(known, holder, cavity)) continue;
      const Fact in = Of(FactKind::kIn, thing, other, cavity);
      const int door = holder.cavities[c].door;
      std::vector<Fact> put = {held}, take = {kEmpty};
      if (door >= 0) {
        // The door is opened first, because a gripper that holds an object cannot open it.
        put.insert(put.begin(), Of(FactKind::kJointAway, other, -1, door));
        take.insert(take.begin(), Of(FactKind::kJointAway, other, -1, door));
      }
      operators->push_back({Verb::kPutInto, thing, other, cavity, {}, put, {in, kEmpty}, {held}});
      operators->push_back(
          {Verb::kPick, thing, other, cavity, {in, free}, take, {held}, {kEmpty, in}});
    }
    if (CanPour(known) && !holder.articulated() && CanPour(holder)) {
      operators->push_back(
          {Verb::kPour, thing, other, -1, {}, {held}, {Of(FactKind::kPoured, thing, other)}, {}});
    }
  }
}

}  // namespace

std::vector<Operator> OperatorsFor(const SceneModel& model, const std::vector<int>& things) {
  std::vector<Operator> operators;
  for (int thing : things) {
    const Thing& known = model.things[static_cast<std::size_t>(thing)];
    AddJoints(known, thing, &operators);
    if (CanBeLifted(known)) AddHandling(model, thing, things, &operators);
    if (CanBePushed(known)) {
      operators.push_back({Verb::kPush,
                           thing,
                           -1,
                           -1,
                           {Of(FactKind::kOnFloor, thing), Of(FactKind::kFree, thing)},
                           {kEmpty},
                           {Of(FactKind::kPushed, thing)},
                           {}});
    }
  }
  return operators;
}

}  // namespace simwright::tasks
