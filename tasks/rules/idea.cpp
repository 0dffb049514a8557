#include "tasks/rules/idea.h"

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
  CandidateGenerator(const SceneModel& model, std::size_t most, core::Rng& rng)
      : model_(model), most_(most), rng_(rng) {
    order_.resize(model.things.size());
    std::iota(order_.begin(), order_.end(), 0);
    core::Shuffle(&order_, rng_);
    for (int t : order_) {
      if (CanBeLifted(Known(t))) lifted_.push_back(t);
      if (!Known(t).cavities.empty()) holders_.push_back(t);
    }
  }

  std::vector<Idea> Generate() {
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
  const Thing& Known(int thing) const { return model_.things[static_cast<std::size_t>(thing)]; }
  std::string Spoken(int thing) const { return SpokenName(Known(thing)); }

  void Joints() {
    std::vector<Idea> away, back, all;
    for (int t : order_) {
      const Thing& thing = Known(t);
      std::vector<Fact> open;
      for (std::size_t j = 0; j < thing.joints.size(); ++j) {
        const JointUse use = UseOf(thing, thing.joints[j]);
        if (use == JointUse::kNone) continue;
        const int joint = static_cast<int>(j);
        Idea candidate;
        candidate.layout.things = {t};
        candidate.layout.worked = {{t, joint}};
        candidate.goals = {{FactKind::kJointAway, t, -1, joint}};
        away.push_back(candidate);
        if (use == JointUse::kOpen || use == JointUse::kSlide) open.push_back(candidate.goals[0]);
        if (use == JointUse::kPress) continue;
        candidate.goals = {{FactKind::kJointAtRest, t, -1, joint}};
        candidate.layout.joints = {{thing.name, thing.joints[j].name, thing.joints[j].acted()}};
        back.push_back(candidate);
      }
      if (open.size() >= 2) all.push_back(OpenAll(t, open));
    }
    kinds_.push_back(std::move(away));
    kinds_.push_back(std::move(back));
    kinds_.push_back(std::move(all));
  }

  Idea OpenAll(int thing, std::vector<Fact> open) {
    Idea candidate;
    candidate.name = NameFrom("open_all_of_" + Known(thing).name);
    candidate.description = "Open everything that opens on the " + Spoken(thing) + ".";
    candidate.layout.things = {thing};
    if (open.size() > 4) open.resize(4);
    for (const Fact& fact : open) candidate.layout.worked.emplace_back(thing, fact.part);
    candidate.goals = open;
    return candidate;
  }

  void Single() {
    std::vector<Idea> picked, moved, pushed;
    for (int t : order_) {
      Idea candidate;
      candidate.layout.things = {t};
      if (CanBeLifted(Known(t))) {
        candidate.goals = {{FactKind::kHolding, t}};
        picked.push_back(candidate);
        candidate.name = NameFrom("move_" + Known(t).name);
        candidate.description = "Take the " + Spoken(t) + " and put it down at the goal.";
        candidate.goals = {{FactKind::kAtGoal, t}};
        moved.push_back(candidate);
        candidate.name.clear();
        candidate.description.clear();
      }
      if (CanBePushed(Known(t))) {
        candidate.goals = {{FactKind::kPushed, t}};
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
    std::vector<Idea> candidates;
    EachPair(lifted_, order_, [&](int thing, int holder) {
      if (!StandsOn(Known(thing), Known(holder)) || Known(holder).height() > 0.6) return;
      Idea candidate;
      candidate.name = NameFrom("place_" + Known(thing).name + "_on_" + Known(holder).name);
      candidate.description =
          "Pick up the " + Spoken(thing) + " and stand it on the " + Spoken(holder) + ".";
      candidate.layout.things = {thing, holder};
      candidate.goals = {{FactKind::kOn, thing, holder}};
      candidates.push_back(std::move(candidate));
    });
    kinds_.push_back(std::move(candidates));
  }

  void Into() {
    std::vector<Idea> put, taken, used;
    EachPair(lifted_, holders_, [&](int thing, int holder) {
      const Thing& known = Known(holder);
      for (std::size_t c = 0; c < known.cavities.size() && c < 3; ++c) {
        const int cavity = static_cast<int>(c);
        if (!FitsInto(Known(thing), known, cavity)) continue;
        put.push_back(PutCandidate(thing, holder, cavity));
        taken.push_back(TakeCandidate(thing, holder, cavity));
        const int control = ControlOf(known, known.cavities[c].door);
        if (control >= 0 && known.cavities[c].door >= 0) {
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
  int ControlOf(const Thing& thing, int door) const {
    for (std::size_t j = 0; j < thing.joints.size(); ++j) {
      const JointUse use = UseOf(thing, thing.joints[j]);
      const bool control =
          use == JointUse::kTurn || use == JointUse::kPress || use == JointUse::kSwitch;
      if (control && static_cast<int>(j) != door) return static_cast<int>(j);
    }
    return -1;
  }

  Idea PutCandidate(int thing, int holder, int cavity) {
    const int door = Known(holder).cavities[static_cast<std::size_t>(cavity)].door;
    Idea candidate;
    candidate.name = NameFrom("put_" + Known(thing).name + "_into_" + Known(holder).name);
    candidate.description = "Put the " + Spoken(thing) + " into the " + Spoken(holder);
    candidate.layout.things = {holder, thing};
    candidate.goals = {{FactKind::kIn, thing, holder, cavity}};
    if (door >= 0) {
      candidate.name += "_and_close_it";
      candidate.description += " and close it";
      candidate.layout.worked = {{holder, door}};
      candidate.goals.push_back({FactKind::kJointAtRest, holder, -1, door});
    }
    candidate.description += ".";
    return candidate;
  }

  Idea TakeCandidate(int thing, int holder, int cavity) {
    const int door = Known(holder).cavities[static_cast<std::size_t>(cavity)].door;
    Idea candidate;
    candidate.name = NameFrom("take_" + Known(thing).name + "_out_of_" + Known(holder).name);
    candidate.description = "Take the " + Spoken(thing) + " out of the " + Spoken(holder) + ".";
    candidate.layout.things = {holder, thing};
    candidate.layout.resting = {{thing, holder, cavity}};
    candidate.goals = {{FactKind::kAtGoal, thing}};
    if (door >= 0) candidate.layout.worked = {{holder, door}};
    return candidate;
  }

  Idea UseCandidate(Idea put, int holder, int control) {
    const Thing& known = Known(holder);
    const ThingJoint& joint = known.joints[static_cast<std::size_t>(control)];
    const bool press = UseOf(known, joint) == JointUse::kPress;
    put.name +=
        NameFrom(std::string(press ? "_and_press_" : "_and_turn_on_") + PartName(known, joint));
    put.description.back() = ',';
    put.description += std::string(press ? " then press" : " then turn on") + " the " +
                       PartName(known, joint) + ".";
    put.layout.worked.emplace_back(holder, control);
    put.goals.push_back({FactKind::kJointAway, holder, -1, control});
    return put;
  }

  void Pour() {
    std::vector<Idea> candidates;
    EachPair(lifted_, lifted_, [&](int thing, int other) {
      if (!CanPour(Known(thing)) || !CanPour(Known(other))) return;
      Idea candidate;
      candidate.name = NameFrom("pour_from_" + Known(thing).name + "_into_" + Known(other).name);
      candidate.description =
          "Pick up the " + Spoken(thing) + " and pour from it into the " + Spoken(other) + ".";
      candidate.layout.things = {thing, other};
      candidate.goals = {{FactKind::kPoured, thing, other}};
      candidates.push_back(std::move(candidate));
    });
    kinds_.push_back(std::move(candidates));
  }

  void Stacks() {
    std::vector<Idea> candidates;
    EachPair(lifted_, lifted_, [&](int top, int middle) {
      if (!StandsOn(Known(top), Known(middle))) return;
      for (int base : order_) {
        const bool apart = base != top && base != middle && !Known(base).articulated();
        if (!apart || !StandsOn(Known(middle), Known(base)) || Known(base).height() > 0.4) continue;
        Idea candidate;
        candidate.name = NameFrom("stack_" + Known(top).name + "_" + Known(middle).name + "_" +
                                  Known(base).name);
        candidate.description = "Stack the " + Spoken(middle) + " on the " + Spoken(base) +
                                " and the " + Spoken(top) + " on top.";
        candidate.layout.things = {top, middle, base};
        candidate.goals = {{FactKind::kOn, middle, base}, {FactKind::kOn, top, middle}};
        candidates.push_back(std::move(candidate));
        return;
      }
    });
    kinds_.push_back(std::move(candidates));
  }

  // Collects tasks that put two objects into one receptacle with a door.
  void Stores() {
    std::vector<Idea> candidates;
    EachPair(lifted_, lifted_, [&](int first, int second) {
      if (first > second) return;
      for (int holder : holders_) {
        const Thing& known = Known(holder);
        if (holder == first || holder == second || known.cavities[0].door < 0) continue;
        if (!FitsInto(Known(first), known, 0) || !FitsInto(Known(second), known, 0)) continue;
        Idea candidate = PutCandidate(first, holder, 0);
        candidate.name = NameFrom("store_" + Known(first).name + "_and_" + Known(second).name +
                                  "_in_" + known.name);
        candidate.description = "Put the " + Spoken(first) + " and the " + Spoken(second) +
                                " into the " + Spoken(holder) + " and close it.";
        candidate.layout.things.push_back(second);
        candidate.goals.insert(candidate.goals.begin() + 1, {FactKind::kIn, second, holder, 0});
        candidates.push_back(std::move(candidate));
        std::rotate(holders_.begin(), holders_.begin() + 1, holders_.end());
        return;
      }
    });
    kinds_.push_back(std::move(candidates));
  }

  std::vector<Idea> Interleave() {
    std::vector<Idea> mixed;
    bool any = true;
    for (std::size_t turn = 0; any && mixed.size() < most_; ++turn) {
      any = false;
      for (std::vector<Idea>& kind : kinds_) {
        if (turn >= kind.size() || mixed.size() == most_) continue;
        any = true;
        mixed.push_back(std::move(kind[turn]));
      }
    }
    return mixed;
  }

  const SceneModel& model_;
  std::size_t most_;
  core::Rng& rng_;
  std::vector<int> order_, lifted_, holders_;
  std::vector<std::vector<Idea>> kinds_;
};

}  // namespace

std::vector<Idea> ThinkOfTasks(const SceneModel& model, std::size_t most, core::Rng& rng) {
  return CandidateGenerator(model, most, rng).Generate();
}

}  // namespace simwright::tasks
