#include "tasks/verification/action_sampling.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace simwright::tasks {
namespace {

constexpr double kLiftAction = 0.3;  // m
constexpr double kAside = 0.25;      // m
constexpr double kTurnOver = 2.6;    // rad
constexpr double kTooFar = 4.0;      // m
constexpr double kOvershoot = 0.35;  // overshoot, as a share of the joint's range
constexpr int kMaxChains = 400;
constexpr int kMaxReceptacles = 4;  // per object

class Sampler {
 public:
  Sampler(const WorldModel& model, const WorldState& start,
          const std::vector<reward::RewardSlot>& slots)
      : model_(model), start_(start) {
    for (const reward::RewardSlot& slot : slots) AddSlot(slot);
  }

  ActionSequences Sample() {
    for (int object : objects_) {
      const ArticulatedObject& known = model_.objects[static_cast<std::size_t>(object)];
      if (known.articulated()) {
        for (std::size_t j = 0; j < known.joints.size(); ++j) AddJoint(object, static_cast<int>(j));
      } else {
        AddObject(object);
      }
    }
    for (const auto& [object, link] : links_) {
      sequences_.single.push_back(
          {{ActionKind::kReach, object, link, 0.0, Eigen::Vector3d::Zero()}});
    }
    Chain();
    return std::move(sequences_);
  }

 private:
  void AddSlot(const reward::RewardSlot& slot) {
    const int object = model_.Find(slot.asset);
    if (object < 0) return;
    objects_.insert(object);
    const ArticulatedObject& known = model_.objects[static_cast<std::size_t>(object)];
    const int link = slot.part.empty() ? 0 : known.FindLink(slot.part);
    if (link >= 0) links_.insert({object, link});
    const int joint = slot.part.empty() ? -1 : known.FindJoint(slot.part);
    if (joint >= 0) joints_.insert({object, joint});
    // A link is moved by the joints above it.
    for (int at = link; at > 0;) {
      const int moved_by = known.links[static_cast<std::size_t>(at)].joint;
      if (moved_by >= 0) joints_.insert({object, moved_by});
      at = known.kinematics->ParentLink(at);
    }
  }

  bool Articulated(int object) const {
    return model_.objects[static_cast<std::size_t>(object)].articulated();
  }

  void AddJoint(int object, int index) {
    if (!joints_.contains({object, index})) return;
    const ObjectJoint& joint =
        model_.objects[static_cast<std::size_t>(object)].joints[static_cast<std::size_t>(index)];
    const double now =
        start_.joints[static_cast<std::size_t>(object)][static_cast<std::size_t>(index)];
    const double range = joint.upper - joint.lower;
    const auto move = [&](double position) {
      return Action{ActionKind::kMoveJoint, object, index, position, Eigen::Vector3d::Zero()};
    };
    for (double end : {joint.far(), joint.lower, joint.upper}) {
      if (std::abs(end - now) < 0.02 * range) continue;
      if (!moves_.empty() && moves_.back().object == object && moves_.back().part == index &&
          moves_.back().position == end) {
        continue;
      }
      moves_.push_back(move(end));
      sequences_.single.push_back({move(end)});
    }
    // A joint that starts half open may have to move in both directions.
    sequences_.beyond_limits.push_back({move(joint.upper + kOvershoot * range)});
    sequences_.beyond_limits.push_back({move(joint.lower - kOvershoot * range)});
  }

  void Carry(ActionKind kind, int object, const Eigen::Vector3d& target, double angle = 0.0) {
    const Action action{kind, object, -1, angle, target};
    handlings_.push_back(action);
    sequences_.single.push_back({action});
  }

  void AddObject(int object) {
    const Eigen::AlignedBox3d box = WorldAabb(model_, start_, object);
    const Eigen::Vector3d middle = box.center();
    const Eigen::Vector3d up(0, 0, kLiftAction);
    Carry(ActionKind::kCarry, object, middle + up);
    Carry(ActionKind::kTilt, object, middle + up, kTurnOver);
    if (!start_.goal.isZero()) {
      Carry(ActionKind::kCarry, object, start_.goal);
      Carry(ActionKind::kPlace, object, start_.goal);
      Carry(ActionKind::kPush, object, start_.goal);
    }
    for (double side : {-kAside, kAside}) {
      Eigen::Vector3d aside = middle + Eigen::Vector3d(0, side, 0);
      aside.z() = 0.5 * box.sizes().z();
      Carry(ActionKind::kPlace, object, aside);
      Carry(ActionKind::kPush, object, middle + Eigen::Vector3d(0, side, 0));
      Carry(ActionKind::kPush, object, middle + Eigen::Vector3d(side, 0, 0));
    }
    // Free floor to the robot's left and right.
    for (double side : {-0.35, 0.35}) {
      Eigen::Vector3d free = start_.gripper.translation() + Eigen::Vector3d(0.05, side, 0);
      free.z() = 0.5 * box.sizes().z();
      Carry(ActionKind::kPlace, object, free);
    }
    for (int other : objects_) {
      if (other != object) AddOnto(object, other, box);
    }
    for (const Eigen::Vector3d& offset :
         {Eigen::Vector3d(0, 0, kTooFar), Eigen::Vector3d(kTooFar, 0, 0),
          Eigen::Vector3d(0, kTooFar, 0)}) {
      sequences_.too_far.push_back({{ActionKind::kCarry, object, -1, 0.0, middle + offset}});
    }
  }

  void AddOnto(int object, int other, const Eigen::AlignedBox3d& box) {
    const auto o = static_cast<std::size_t>(other);
    const ArticulatedObject& holder = model_.objects[o];
    const double half = 0.5 * box.sizes().z();
    const Eigen::AlignedBox3d body = WorldAabb(model_, start_, other, 0);
    Eigen::Vector3d on_top = body.center();
    on_top.z() = body.max().z() + half + 1e-3;
    Carry(ActionKind::kPlace, object, on_top);
    Eigen::Vector3d beside = body.center();
    beside.y() += 0.5 * (body.sizes().y() + box.sizes().y()) + 0.05;
    beside.z() = half;
    Carry(ActionKind::kPlace, object, beside);
    if (!holder.articulated()) {
      Carry(ActionKind::kTilt, object, on_top + Eigen::Vector3d(0, 0, 0.1), kTurnOver);
    }
    // On top of and inside the parts that the program names.
    for (const auto& [owner, link] : links_) {
      if (owner != other || holder.links[static_cast<std::size_t>(link)].extreme_points.empty())
        continue;
      const Eigen::AlignedBox3d part = WorldAabb(model_, start_, other, link);
      Carry(ActionKind::kPlace, object, part.center());
      Eigen::Vector3d above = part.center();
      above.z() = part.max().z() + half + 1e-3;
      if (link > 0) Carry(ActionKind::kPlace, object, above);
    }
    const std::vector<Eigen::Isometry3d> poses = LinkPosesOf(holder, start_.joints[o]);
    int receptacles = 0;
    for (const Receptacle& receptacle : holder.receptacles) {
      if (++receptacles > kMaxReceptacles) break;
      Eigen::Vector3d inside = start_.roots[o] * poses[static_cast<std::size_t>(receptacle.link)] *
                               receptacle.box.center();
      inside.z() += half - 0.5 * receptacle.box.sizes().z() + 1e-3;
      Carry(ActionKind::kPlace, object, inside);
    }
  }

  void Chain() {
    std::vector<std::vector<Action>>& chains = sequences_.chained;
    const auto add = [&](std::vector<Action> chain) {
      if (static_cast<int>(chains.size()) < kMaxChains) chains.push_back(std::move(chain));
    };
    for (const Action& move : moves_) {
      for (const Action& handling : handlings_) {
        add({move, handling});
        add({handling, move});
      }
      for (const Action& other : moves_) {
        if (&other != &move && (other.object != move.object || other.part != move.part)) {
          add({move, other});
        }
      }
    }
    for (const Action& handling : handlings_) {
      for (const Action& other : handlings_) {
        if (other.object != handling.object && handling.kind == ActionKind::kPlace) {
          add({handling, other});
        }
      }
    }
    for (const Action& move : moves_) {
      for (const Action& handling : handlings_) {
        if (handling.kind != ActionKind::kPlace) continue;
        Action back = move;
        back.position =
            start_
                .joints[static_cast<std::size_t>(move.object)][static_cast<std::size_t>(move.part)];
        add({move, handling, back});
      }
    }
  }

  const WorldModel& model_;
  const WorldState& start_;
  std::set<int> objects_;
  std::set<std::pair<int, int>> links_, joints_;
  std::vector<Action> moves_, handlings_;
  ActionSequences sequences_;
};

}  // namespace

ActionSequences SampleActions(const WorldModel& model, const WorldState& start,
                              const std::vector<reward::RewardSlot>& slots) {
  return Sampler(model, start, slots).Sample();
}

}  // namespace simwright::tasks
