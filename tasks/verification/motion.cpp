#include "tasks/verification/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace simwright::tasks {
namespace {

constexpr int kApproachSteps = 10;
constexpr int kJointSteps = 30;
constexpr int kCarrySteps = 16;
constexpr int kLowerSteps = 12;
constexpr double kCarryHeight = 0.12;  // m above the higher of start and target
constexpr double kRetreat = 0.1;       // m along the approach
constexpr double kOpen = 0.08;         // m between the fingers

class MotionMaker {
 public:
  MotionMaker(const WorldModel& model, const WorldState& start) : model_(model), state_(start) {
    if (state_.grasped) Hold(state_.touched);
    Record(MotionPhase::kApproach);
  }

  void Do(const Action& action) {
    switch (action.kind) {
      case ActionKind::kReach:
        return Approach(LinkPosition(model_, state_, action.object, action.part), std::nullopt);
      case ActionKind::kMoveJoint:
        return MoveJoint(action.object, action.part, action.position);
      case ActionKind::kCarry:
      case ActionKind::kPlace:
        Grasp(action.object);
        MoveHeldObject(action.target, action.kind == ActionKind::kPlace);
        if (action.kind == ActionKind::kPlace) Release();
        return;
      case ActionKind::kPush:
        return Push(action.object, action.target);
      case ActionKind::kTilt:
        Grasp(action.object);
        MoveHeldObject(action.target, false);
        return Tilt(action.position);
    }
  }

  Motion Take() { return std::move(motion_); }

 private:
  void Record(MotionPhase phase) {
    motion_.states.push_back(state_);
    motion_.phases.push_back(phase);
  }

  Eigen::Vector3d Center(int object) const { return WorldAabb(model_, state_, object).center(); }

  void Hold(int object) {
    held_ = object;
    gripper_from_held_ = state_.gripper.inverse() * state_.roots[static_cast<std::size_t>(object)];
  }

  void MoveGripper(const Eigen::Isometry3d& to, double share) {
    const Eigen::Quaterniond a(from_.linear()), b(to.linear());
    state_.gripper.translation() = (1.0 - share) * from_.translation() + share * to.translation();
    state_.gripper.linear() = a.slerp(share, b).normalized().toRotationMatrix();
    if (held_ >= 0) {
      state_.roots[static_cast<std::size_t>(held_)] = state_.gripper * gripper_from_held_;
    }
  }

  void Travel(const Eigen::Isometry3d& to, int steps, MotionPhase phase) {
    from_ = state_.gripper;
    for (int i = 1; i <= steps; ++i) {
      MoveGripper(to, static_cast<double>(i) / steps);
      Record(phase);
    }
  }

  // Moves the gripper to `point`, with its z axis along `approach` or its orientation unchanged.
  void Approach(const Eigen::Vector3d& point, const std::optional<Eigen::Vector3d>& approach) {
    Eigen::Isometry3d to = state_.gripper;
    to.translation() = point;
    if (approach) {
      const Eigen::Vector3d z = state_.gripper.linear().col(2);
      to.linear() = Eigen::Quaterniond::FromTwoVectors(z, *approach).toRotationMatrix() *
                    state_.gripper.linear();
    }
    Travel(to, kApproachSteps, MotionPhase::kApproach);
  }

  void Grasp(int object) {
    if (held_ == object) return;
    if (held_ >= 0) Release();
    Approach(Center(object), -Eigen::Vector3d::UnitZ());
    Touch(object, 0);
    const Eigen::Vector3d size = WorldAabb(model_, state_, object).sizes();
    state_.opening = std::min(kOpen, size.head<2>().minCoeff());
    Hold(object);
    Record(MotionPhase::kMove);
  }

  void Touch(int object, int link) {
    state_.touched = object;
    state_.touched_link = link;
    state_.grasped = true;
  }

  void Release() {
    held_ = -1;
    state_.touched = state_.touched_link = -1;
    state_.grasped = false;
    state_.opening = kOpen;
    Record(MotionPhase::kRelease);
    Eigen::Isometry3d back = state_.gripper;
    back.translation() -= kRetreat * state_.gripper.linear().col(2);
    Travel(back, 2, MotionPhase::kRelease);
  }

  // Moves the held object's centre to `target`; if `lower` is true, up, across and down.
  void MoveHeldObject(const Eigen::Vector3d& target, bool lower) {
    const Eigen::Vector3d offset = state_.gripper.translation() - Center(held_);
    const Eigen::Vector3d start = Center(held_);
    const auto go = [&](const Eigen::Vector3d& middle, int steps) {
      Eigen::Isometry3d to = state_.gripper;
      to.translation() = middle + offset;
      Travel(to, steps, MotionPhase::kMove);
    };
    if (!lower) return go(target, kCarrySteps + kLowerSteps);
    const double height = std::max(start.z(), target.z()) + kCarryHeight;
    go({start.x(), start.y(), height}, kLowerSteps);
    go({target.x(), target.y(), height}, kCarrySteps);
    go(target, kLowerSteps);
  }

  void Tilt(double angle) {
    from_ = state_.gripper;
    for (int i = 1; i <= kJointSteps; ++i) {
      Eigen::Isometry3d to = from_;
      to.linear() =
          Eigen::AngleAxisd(angle * i / kJointSteps, Eigen::Vector3d::UnitY()) * from_.linear();
      state_.gripper = to;
      state_.roots[static_cast<std::size_t>(held_)] = to * gripper_from_held_;
      Record(MotionPhase::kTurnOver);
    }
  }

  void Push(int object, const Eigen::Vector3d& target) {
    if (held_ >= 0) Release();
    const Eigen::Vector3d start = Center(object);
    Eigen::Vector3d displacement = target - start;
    displacement.z() = 0.0;
    const double length = displacement.norm();
    if (!(length > 1e-6)) return;
    const double behind = 0.5 * WorldAabb(model_, state_, object).sizes().head<2>().minCoeff();
    Approach(start - behind * displacement / length, std::nullopt);
    state_.touched = object;
    state_.touched_link = 0;
    const Eigen::Isometry3d root = state_.roots[static_cast<std::size_t>(object)];
    const Eigen::Vector3d gripper_start = state_.gripper.translation();
    for (int i = 1; i <= kJointSteps; ++i) {
      const Eigen::Vector3d moved = displacement * i / kJointSteps;
      state_.roots[static_cast<std::size_t>(object)].translation() = root.translation() + moved;
      state_.gripper.translation() = gripper_start + moved;
      Record(MotionPhase::kMove);
    }
  }

  // Returns the objects inside the link that the joint moves.
  std::vector<int> Contents(int object, int link) const {
    const Eigen::AlignedBox3d box = WorldAabb(model_, state_, object, link);
    std::vector<int> contents;
    for (std::size_t other = 0; other < model_.objects.size(); ++other) {
      if (static_cast<int>(other) == object || model_.objects[other].articulated()) continue;
      if (static_cast<int>(other) == held_) continue;
      if (box.contains(Center(static_cast<int>(other)))) {
        contents.push_back(static_cast<int>(other));
      }
    }
    return contents;
  }

  Eigen::Isometry3d LinkPose(int object, int link) const {
    const auto t = static_cast<std::size_t>(object);
    return state_.roots[t] *
           LinkPosesOf(model_.objects[t], state_.joints[t])[static_cast<std::size_t>(link)];
  }

  void MoveJoint(int object, int index, double position) {
    if (held_ >= 0) Release();
    const auto t = static_cast<std::size_t>(object), j = static_cast<std::size_t>(index);
    const ObjectJoint& joint = model_.objects[t].joints[j];
    const Eigen::Vector3d grip = LinkPosition(model_, state_, object, joint.grasp_link);
    Eigen::Vector3d towards = grip - state_.gripper.translation();
    towards.z() = 0.0;
    Approach(grip, towards.norm() > 1e-6 ? towards.normalized() : -Eigen::Vector3d::UnitZ());
    Touch(object, joint.grasp_link);
    state_.opening = 0.02;
    const Eigen::Isometry3d link_from_gripper =
        LinkPose(object, joint.link).inverse() * state_.gripper;
    const std::vector<int> contents = Contents(object, joint.link);
    const double start = state_.joints[t][j];
    for (int i = 1; i <= kJointSteps; ++i) {
      const Eigen::Isometry3d before = LinkPose(object, joint.link);
      state_.joints[t][j] = start + (position - start) * i / kJointSteps;
      const Eigen::Isometry3d after = LinkPose(object, joint.link);
      state_.gripper = after * link_from_gripper;
      for (int content : contents) {
        Eigen::Isometry3d& root = state_.roots[static_cast<std::size_t>(content)];
        root = after * before.inverse() * root;
      }
      Record(MotionPhase::kMove);
    }
    ReleaseJoint();
  }

  // Releases a joint at its current position.
  void ReleaseJoint() {
    state_.touched = state_.touched_link = -1;
    state_.grasped = false;
    state_.opening = kOpen;
    Record(MotionPhase::kRelease);
  }

  const WorldModel& model_;
  WorldState state_;
  Motion motion_;
  Eigen::Isometry3d from_ = Eigen::Isometry3d::Identity();
  int held_ = -1;
  Eigen::Isometry3d gripper_from_held_ = Eigen::Isometry3d::Identity();
};

}  // namespace

Motion MakeMotion(const WorldModel& model, const WorldState& start,
                  const std::vector<Action>& actions) {
  MotionMaker maker(model, start);
  for (const Action& action : actions) maker.Do(action);
  return maker.Take();
}

}  // namespace simwright::tasks
