#include "tasks/rules/affordances.h"
#include "tasks/rules/planner.h"

namespace simwright::tasks {
namespace {

const Predicate kEmpty{PredicateKind::kGripperEmpty};

Predicate Of(PredicateKind kind, int object, int other = -1, int part = -1) {
  return {kind, object, other, part};
}

void AddJoints(const ArticulatedObject& known, int object, std::vector<Operator>* operators) {
  for (std::size_t j = 0; j < known.joints.size(); ++j) {
    const JointUse use = GetJointUse(known, known.joints[j]);
    if (use == JointUse::kNone) continue;
    const int joint = static_cast<int>(j);
    const Predicate away = Of(PredicateKind::kJointAway, object, -1, joint);
    const Predicate rest = Of(PredicateKind::kJointAtRest, object, -1, joint);
    operators->push_back({ActionType::kOpen, object, -1, joint, {rest}, {kEmpty}, {away}, {rest}});
    if (use == JointUse::kPress) continue;
    operators->push_back({ActionType::kClose, object, -1, joint, {away}, {kEmpty}, {rest}, {away}});
  }
}

// Adds operators that take an object from each possible place and put it down again.
void AddHandling(const WorldModel& model, int object, const std::vector<int>& objects,
                 std::vector<Operator>* operators) {
  const Predicate held = Of(PredicateKind::kHolding, object),
                  floor = Of(PredicateKind::kOnFloor, object);
  const Predicate free = Of(PredicateKind::kFree, object);
  operators->push_back(
      {ActionType::kPick, object, -1, -1, {floor, free}, {kEmpty}, {held}, {kEmpty, floor}});
  const Predicate at_goal = Of(PredicateKind::kAtGoal, object);
  operators->push_back(
      {ActionType::kPutDown, object, -1, -1, {}, {held}, {kEmpty, floor, at_goal}, {held}});
  const ArticulatedObject& known = model.objects[static_cast<std::size_t>(object)];
  for (int other : objects) {
    if (other == object) continue;
    const ArticulatedObject& holder = model.objects[static_cast<std::size_t>(other)];
    if (CanStandOn(known, holder)) {
      const Predicate on = Of(PredicateKind::kOn, object, other),
                      bare = Of(PredicateKind::kFree, other);
      operators->push_back(
          {ActionType::kPlaceOn, object, other, -1, {bare}, {held}, {on, kEmpty}, {held, bare}});
      operators->push_back(
          {ActionType::kPick, object, other, -1, {on, free}, {kEmpty}, {held, bare}, {kEmpty, on}});
    }
    for (std::size_t c = 0; c < holder.receptacles.size(); ++c) {
      const int receptacle = static_cast<int>(c);
      if (!FitsInto(known, holder, receptacle)) continue;
      const Predicate in = Of(PredicateKind::kIn, object, other, receptacle);
      const int door = holder.receptacles[c].door;
      std::vector<Predicate> put = {held}, take = {kEmpty};
      if (door >= 0) {
        // The door is opened first, because a gripper that holds an object cannot open it.
        put.insert(put.begin(), Of(PredicateKind::kJointAway, other, -1, door));
        take.insert(take.begin(), Of(PredicateKind::kJointAway, other, -1, door));
      }
      operators->push_back(
          {ActionType::kPutInto, object, other, receptacle, {}, put, {in, kEmpty}, {held}});
      operators->push_back(
          {ActionType::kPick, object, other, receptacle, {in, free}, take, {held}, {kEmpty, in}});
    }
    if (CanPour(known) && !holder.articulated() && CanPour(holder)) {
      operators->push_back({ActionType::kPour,
                            object,
                            other,
                            -1,
                            {},
                            {held},
                            {Of(PredicateKind::kPoured, object, other)},
                            {}});
    }
  }
}

}  // namespace

std::vector<Operator> OperatorsFor(const WorldModel& model, const std::vector<int>& objects) {
  std::vector<Operator> operators;
  for (int object : objects) {
    const ArticulatedObject& known = model.objects[static_cast<std::size_t>(object)];
    AddJoints(known, object, &operators);
    if (CanBeLifted(known)) AddHandling(model, object, objects, &operators);
    if (CanBePushed(known)) {
      operators.push_back({ActionType::kPush,
                           object,
                           -1,
                           -1,
                           {Of(PredicateKind::kOnFloor, object), Of(PredicateKind::kFree, object)},
                           {kEmpty},
                           {Of(PredicateKind::kPushed, object)},
                           {}});
    }
  }
  return operators;
}

}  // namespace simwright::tasks
