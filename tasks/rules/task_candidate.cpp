#include "tasks/rules/task_candidate.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include "core/shuffle.h"
#include "tasks/rules/affordances.h"
#include "tasks/rules/step.h"

namespace simwright::tasks {
namespace {

// A collector of candidates for each kind of task.
class CandidateGenerator {
 public:
  CandidateGenerator(const WorldModel& model, std::size_t most, core::Rng& rng)
      : model_(model), most_(most), rng_(rng) {
    order_.resize(model.objects.size());
    std::iota(order_.begin(), order_.end(), 0);
    core::Shuffle(&order_, rng_);
    for (int t : order_) {
      if (CanBeLifted(Known(t))) lifted_.push_back(t);
      if (!Known(t).receptacles.empty()) holders_.push_back(t);
    }
  }

  std::vector<TaskCandidate> Generate() {
    Joints();
    Single();
    Onto();
    Into();
    Pour();
    Stacks();
    Stores();
    return Interleave();
  }

 private:
  const ArticulatedObject& Known(int object) const {
    return model_.objects[static_cast<std::size_t>(object)];
  }
  std::string Spoken(int object) const { return SpokenName(Known(object)); }

  void Joints() {
    std::vector<TaskCandidate> away, back, all;
    for (int t : order_) {
      const ArticulatedObject& object = Known(t);
      std::vector<Predicate> open;
      for (std::size_t j = 0; j < object.joints.size(); ++j) {
        const JointUse use = GetJointUse(object, object.joints[j]);
        if (use == JointUse::kNone) continue;
        const int joint = static_cast<int>(j);
        TaskCandidate candidate;
        candidate.layout.objects = {t};
        candidate.layout.operated = {{t, joint}};
        candidate.goals = {{PredicateKind::kJointAway, t, -1, joint}};
        away.push_back(candidate);
        if (use == JointUse::kOpen || use == JointUse::kSlide) open.push_back(candidate.goals[0]);
        if (use == JointUse::kPress) continue;
        candidate.goals = {{PredicateKind::kJointAtRest, t, -1, joint}};
        candidate.layout.joints = {
            {object.name, object.joints[j].name, object.joints[j].joint_target()}};
        back.push_back(candidate);
      }
      if (open.size() >= 2) all.push_back(OpenAll(t, open));
    }
    kinds_.push_back(std::move(away));
    kinds_.push_back(std::move(back));
    kinds_.push_back(std::move(all));
  }

  TaskCandidate OpenAll(int object, std::vector<Predicate> open) {
    TaskCandidate candidate;
    candidate.name = NameFrom("open_all_of_" + Known(object).name);
    candidate.description = "Open everything that opens on the " + Spoken(object) + ".";
    candidate.layout.objects = {object};
    if (open.size() > 4) open.resize(4);
    for (const Predicate& predicate : open)
      candidate.layout.operated.emplace_back(object, predicate.part);
    candidate.goals = open;
    return candidate;
  }

  void Single() {
    std::vector<TaskCandidate> picked, moved, pushed;
    for (int t : order_) {
      TaskCandidate candidate;
      candidate.layout.objects = {t};
      if (CanBeLifted(Known(t))) {
        candidate.goals = {{PredicateKind::kHolding, t}};
        picked.push_back(candidate);
        candidate.name = NameFrom("move_" + Known(t).name);
        candidate.description = "Take the " + Spoken(t) + " and put it down at the goal.";
        candidate.goals = {{PredicateKind::kAtGoal, t}};
        moved.push_back(candidate);
        candidate.name.clear();
        candidate.description.clear();
      }
      if (CanBePushed(Known(t))) {
        candidate.goals = {{PredicateKind::kPushed, t}};
        pushed.push_back(candidate);
      }
    }
    kinds_.push_back(std::move(picked));
    kinds_.push_back(std::move(moved));
    kinds_.push_back(std::move(pushed));
  }

  // Visits pairs in a mixed order, up to the number that can be used.
  void EachPair(const std::vector<int>& firsts, const std::vector<int>& seconds,
                const std::function<void(int, int)>& visit) {
    const std::size_t bound = 4 * most_ + 64;
    std::size_t visited = 0;
    for (std::size_t shift = 0; shift < seconds.size(); ++shift) {
      for (std::size_t i = 0; i < firsts.size() && visited < bound; ++i) {
        const int second = seconds[(i + shift) % seconds.size()];
        if (firsts[i] == second) continue;
        ++visited;
        visit(firsts[i], second);
      }
    }
  }

  void Onto() {
    std::vector<TaskCandidate> candidates;
    EachPair(lifted_, order_, [&](int object, int holder) {
      if (!CanStandOn(Known(object), Known(holder)) || Known(holder).height() > 0.6) return;
      TaskCandidate candidate;
      candidate.name = NameFrom("place_" + Known(object).name + "_on_" + Known(holder).name);
      candidate.description =
          "Pick up the " + Spoken(object) + " and stand it on the " + Spoken(holder) + ".";
      candidate.layout.objects = {object, holder};
      candidate.goals = {{PredicateKind::kOn, object, holder}};
      candidates.push_back(std::move(candidate));
    });
    kinds_.push_back(std::move(candidates));
  }

  void Into() {
    std::vector<TaskCandidate> put, taken, used;
    EachPair(lifted_, holders_, [&](int object, int holder) {
      const ArticulatedObject& known = Known(holder);
      for (std::size_t c = 0; c < known.receptacles.size() && c < 3; ++c) {
        const int receptacle = static_cast<int>(c);
        if (!FitsInto(Known(object), known, receptacle)) continue;
        put.push_back(PutCandidate(object, holder, receptacle));
        taken.push_back(TakeCandidate(object, holder, receptacle));
        const int control = ControlOf(known, known.receptacles[c].door);
        if (control >= 0 && known.receptacles[c].door >= 0) {
          used.push_back(UseCandidate(put.back(), holder, control));
        }
        return;
      }
    });
    kinds_.push_back(std::move(put));
    kinds_.push_back(std::move(taken));
    kinds_.push_back(std::move(used));
  }

  // Returns a knob or button of an object that has a door; -1: none.
  int ControlOf(const ArticulatedObject& object, int door) const {
    for (std::size_t j = 0; j < object.joints.size(); ++j) {
      const JointUse use = GetJointUse(object, object.joints[j]);
      const bool control =
          use == JointUse::kTurn || use == JointUse::kPress || use == JointUse::kSwitch;
      if (control && static_cast<int>(j) != door) return static_cast<int>(j);
    }
    return -1;
  }

  TaskCandidate PutCandidate(int object, int holder, int receptacle) {
    const int door = Known(holder).receptacles[static_cast<std::size_t>(receptacle)].door;
    TaskCandidate candidate;
    candidate.name = NameFrom("put_" + Known(object).name + "_into_" + Known(holder).name);
    candidate.description = "Put the " + Spoken(object) + " into the " + Spoken(holder);
    candidate.layout.objects = {holder, object};
    candidate.goals = {{PredicateKind::kIn, object, holder, receptacle}};
    if (door >= 0) {
      candidate.name += "_and_close_it";
      candidate.description += " and close it";
      candidate.layout.operated = {{holder, door}};
      candidate.goals.push_back({PredicateKind::kJointAtRest, holder, -1, door});
    }
    candidate.description += ".";
    return candidate;
  }

  TaskCandidate TakeCandidate(int object, int holder, int receptacle) {
    const int door = Known(holder).receptacles[static_cast<std::size_t>(receptacle)].door;
    TaskCandidate candidate;
    candidate.name = NameFrom("take_" + Known(object).name + "_out_of_" + Known(holder).name);
    candidate.description = "Take the " + Spoken(object) + " out of the " + Spoken(holder) + ".";
    candidate.layout.objects = {holder, object};
    candidate.layout.supports = {{object, holder, receptacle}};
    candidate.goals = {{PredicateKind::kAtGoal, object}};
    if (door >= 0) candidate.layout.operated = {{holder, door}};
    return candidate;
  }

  TaskCandidate UseCandidate(TaskCandidate put, int holder, int control) {
    const ArticulatedObject& known = Known(holder);
    const ObjectJoint& joint = known.joints[static_cast<std::size_t>(control)];
    const bool press = GetJointUse(known, joint) == JointUse::kPress;
    put.name +=
        NameFrom(std::string(press ? "_and_press_" : "_and_turn_on_") + PartName(known, joint));
    put.description.back() = ',';
    put.description += std::string(press ? " then press" : " then turn on") + " the " +
                       PartName(known, joint) + ".";
    put.layout.operated.emplace_back(holder, control);
    put.goals.push_back({PredicateKind::kJointAway, holder, -1, control});
    return put;
  }

  void Pour() {
    std::vector<TaskCandidate> candidates;
    EachPair(lifted_, lifted_, [&](int object, int other) {
      if (!CanPour(Known(object)) || !CanPour(Known(other))) return;
      TaskCandidate candidate;
      candidate.name = NameFrom("pour_from_" + Known(object).name + "_into_" + Known(other).name);
      candidate.description =
          "Pick up the " + Spoken(object) + " and pour from it into the " + Spoken(other) + ".";
      candidate.layout.objects = {object, other};
      candidate.goals = {{PredicateKind::kPoured, object, other}};
      candidates.push_back(std::move(candidate));
    });
    kinds_.push_back(std::move(candidates));
  }

  void Stacks() {
    std::vector<TaskCandidate> candidates;
    EachPair(lifted_, lifted_, [&](int top, int middle) {
      if (!CanStandOn(Known(top), Known(middle))) return;
      for (int base : order_) {
        const bool apart = base != top && base != middle && !Known(base).articulated();
        if (!apart || !CanStandOn(Known(middle), Known(base)) || Known(base).height() > 0.4)
          continue;
        TaskCandidate candidate;
        candidate.name = NameFrom("stack_" + Known(top).name + "_" + Known(middle).name + "_" +
                                  Known(base).name);
        candidate.description = "Stack the " + Spoken(middle) + " on the " + Spoken(base) +
                                " and the " + Spoken(top) + " on top.";
        candidate.layout.objects = {top, middle, base};
        candidate.goals = {{PredicateKind::kOn, middle, base}, {PredicateKind::kOn, top, middle}};
        candidates.push_back(std::move(candidate));
        return;
      }
    });
    kinds_.push_back(std::move(candidates));
  }

  // Collects tasks that put two objects into one receptacle with a door.
  void Stores() {
    std::vector<TaskCandidate> candidates;
    EachPair(lifted_, lifted_, [&](int first, int second) {
      if (first > second) return;
      for (int holder : holders_) {
        const ArticulatedObject& known = Known(holder);
        if (holder == first || holder == second || known.receptacles[0].door < 0) continue;
        if (!FitsInto(Known(first), known, 0) || !FitsInto(Known(second), known, 0)) continue;
        TaskCandidate candidate = PutCandidate(first, holder, 0);
        candidate.name = NameFrom("store_" + Known(first).name + "_and_" + Known(second).name +
                                  "_in_" + known.name);
        candidate.description = "Put the " + Spoken(first) + " and the " + Spoken(second) +
                                " into the " + Spoken(holder) + " and close it.";
        candidate.layout.objects.push_back(second);
        candidate.goals.insert(candidate.goals.begin() + 1,
                               {PredicateKind::kIn, second, holder, 0});
        candidates.push_back(std::move(candidate));
        std::rotate(holders_.begin(), holders_.begin() + 1, holders_.end());
        return;
      }
    });
    kinds_.push_back(std::move(candidates));
  }

  std::vector<TaskCandidate> Interleave() {
    std::vector<TaskCandidate> mixed;
    bool any = true;
    for (std::size_t turn = 0; any && mixed.size() < most_; ++turn) {
      any = false;
      for (std::vector<TaskCandidate>& kind : kinds_) {
        if (turn >= kind.size() || mixed.size() == most_) continue;
        any = true;
        mixed.push_back(std::move(kind[turn]));
      }
    }
    return mixed;
  }

  const WorldModel& model_;
  std::size_t most_;
  core::Rng& rng_;
  std::vector<int> order_, lifted_, holders_;
  std::vector<std::vector<TaskCandidate>> kinds_;
};

}  // namespace

std::vector<TaskCandidate> GenerateCandidates(const WorldModel& model, std::size_t most,
                                              core::Rng& rng) {
  return CandidateGenerator(model, most, rng).Generate();
}

}  // namespace simwright::tasks
