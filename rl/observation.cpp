#include "rl/observation.h"

#include <algorithm>

#include "rl/focus_geometry.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using tasks::RewardInput;

constexpr double kNear = 0.1;  // m, unit of distances near the target
constexpr double kRoom = 0.5;  // m, unit of distances in the scene
constexpr double kFast = 2.0;  // rad/s or m/s

constexpr int kHand = 3 + 6 + 4;            // pose; opening, its command, touch, grasp
constexpr int kFrame = 3 + 6 + 1;           // pose; at the destination
constexpr int kJoint = 2;                   // position, velocity
constexpr int kFocusThing = 3 + 3 + 3 + 3;  // position, upright axis, velocity, size
constexpr int kFocusSize = 3;               // in the target frame
constexpr int kFocusPart = 3 + 3 + 3;       // middle, direction of motion, hinge: for joints
constexpr int kThing = 3 + 3 + 3;           // position, upright axis, size
constexpr int kDestination = 3;

}  // namespace

class Observer::Row {
 public:
  explicit Row(float* row) : next_(row) {}
  void Add(double value) { *next_++ = static_cast<float>(value); }
  void Add(const Vector3d& vector, double unit) {
    for (int i = 0; i < 3; ++i) Add(vector[i] / unit);
  }
  // Adds two axes of a rotation matrix: a continuous representation (Zhou et al., CVPR 2019).
  void Add(const Eigen::Matrix3d& rotation) {
    Add(Vector3d(rotation.col(1)), 1.0);
    Add(Vector3d(rotation.col(2)), 1.0);
  }

 private:
  float* next_;
};

Observer::Observer(const Skill& skill, const SkillVariant& variant)
    : skill_(skill), variant_(variant) {
  const auto add = [](auto* list, const auto& item) {
    if (std::find(list->begin(), list->end(), item) == list->end()) list->push_back(item);
  };
  for (const tasks::RewardSlot& slot : variant.program->slots()) {
    if (slot.asset.empty()) continue;
    const int thing = variant.model.Find(slot.asset);
    const int joint = variant.model.things[static_cast<size_t>(thing)].FindJoint(slot.part);
    if (slot.input == RewardInput::kJointState && joint >= 0) {
      add(&joints_, std::pair<int, int>(thing, joint));
    } else if (!variant.fixed[static_cast<size_t>(thing)] &&
               (!variant.focus || thing != variant.focus->thing)) {
      add(&things_, thing);
    }
  }
}

int Observer::size() const {
  int size = 2 * skill_.robot->arm.size() + kHand + kFrame + ActionSize(skill_);
  size += kJoint * static_cast<int>(joints_.size());
  if (variant_.focus) size += kFocusThing + kFocusSize;
  if (variant_.focus && variant_.focus->joint >= 0) size += kFocusPart;
  size += kThing * static_cast<int>(things_.size());
  return variant_.destination ? size + kDestination : size;
}

void Observer::AddArm(const Senses& senses, Row* row) const {
  for (Eigen::Index j = 0; j < senses.arm->size(); ++j) {
    const robot::ArmJoint& joint = skill_.robot->arm.joints[static_cast<size_t>(j)];
    const double middle = 0.5 * (joint.lower + joint.upper);
    row->Add(2.0 * ((*senses.arm)[j] - middle) / (joint.upper - joint.lower));
  }
  for (Eigen::Index j = 0; j < senses.velocities->size(); ++j) {
    row->Add((*senses.velocities)[j] / kFast);
  }
}

void Observer::AddHand(const tasks::SceneState& state, const Senses& senses, Row* row) const {
  const Isometry3d focus_from_tool = senses.world_from_focus.inverse() * state.gripper;
  row->Add(Vector3d(focus_from_tool.translation()), kNear);
  row->Add(Eigen::Matrix3d(focus_from_tool.linear()));
  const robot::Gripper& gripper = skill_.robot->gripper;
  row->Add(2.0 * state.opening / gripper.MaxOpening() - 1.0);
  row->Add(2.0 * gripper.Opening(senses.leader_command) / gripper.MaxOpening() - 1.0);
  const bool touches_target = variant_.focus && state.touched == variant_.focus->thing;
  row->Add(touches_target ? 1.0 : 0.0);
  row->Add(touches_target && state.grasped ? 1.0 : 0.0);
}

void Observer::AddJoints(const tasks::SceneState& state, const tasks::SceneState* previous,
                         Row* row) const {
  for (const auto& [thing, joint] : joints_) {
    const auto t = static_cast<size_t>(thing), j = static_cast<size_t>(joint);
    const tasks::ThingJoint& known = variant_.model.things[t].joints[j];
    const double range = std::max(known.upper - known.lower, 1e-6);
    row->Add(2.0 * (state.joints[t][j] - known.lower) / range - 1.0);
    const double moved = previous ? state.joints[t][j] - previous->joints[t][j] : 0.0;
    row->Add(moved / (range * skill_.options.decision_seconds()));
  }
}

void Observer::AddFocusThing(const tasks::SceneState& state, const tasks::SceneState* previous,
                             const Eigen::Matrix3d& focus_from_world, Row* row) const {
  const int thing = variant_.focus->thing;
  const auto t = static_cast<size_t>(thing);
  const Vector3d point = tasks::LinkPoint(variant_.model, state, thing, 0);
  row->Add(Vector3d(focus_from_world * (point - state.gripper.translation())), kNear);
  row->Add(Vector3d(focus_from_world * state.roots[t].linear().col(2)), 1.0);
  Vector3d moved = Vector3d::Zero();
  if (previous) moved = point - tasks::LinkPoint(variant_.model, *previous, thing, 0);
  row->Add(Vector3d(focus_from_world * moved), kRoom * skill_.options.decision_seconds());
  row->Add(Vector3d(variant_.model.things[t].box.sizes()), kNear);
}

void Observer::AddFocusGeometry(const tasks::SceneState& state, const Isometry3d& world_from_focus,
                                Row* row) const {
  const FocusGeometry geometry =
      GeometryOf(variant_.model, state, *variant_.focus, world_from_focus);
  row->Add(geometry.size, kNear);
  if (variant_.focus->joint < 0) return;
  row->Add(geometry.middle, kNear);
  row->Add(geometry.way, 1.0);
  row->Add(geometry.hinge, kRoom);
}

void Observer::AddThings(const tasks::SceneState& state, const Eigen::Matrix3d& focus_from_world,
                         Row* row) const {
  for (const int thing : things_) {
    const auto t = static_cast<size_t>(thing);
    const Vector3d point = tasks::LinkPoint(variant_.model, state, thing, 0);
    row->Add(Vector3d(focus_from_world * (point - state.gripper.translation())), kRoom);
    row->Add(Vector3d(focus_from_world * state.roots[t].linear().col(2)), 1.0);
    row->Add(Vector3d(variant_.model.things[t].box.sizes()), kNear);
  }
}

void Observer::Write(const tasks::SceneState& state, const tasks::SceneState* previous,
                     const Senses& senses, float* target) const {
  Row row(target);
  AddArm(senses, &row);
  AddHand(state, senses, &row);
  const Isometry3d base_from_focus =
      variant_.subtask.start.world_from_robot.inverse() * senses.world_from_focus;
  row.Add(Vector3d(base_from_focus.translation()), kRoom);
  row.Add(Eigen::Matrix3d(base_from_focus.linear()));
  row.Add(senses.withdrawing ? -1.0 : senses.at_destination ? 1.0 : 0.0);
  AddJoints(state, previous, &row);
  const Eigen::Matrix3d focus_from_world = senses.world_from_focus.linear().transpose();
  if (variant_.focus) {
    AddFocusThing(state, previous, focus_from_world, &row);
    AddFocusGeometry(state, senses.world_from_focus, &row);
  }
  AddThings(state, focus_from_world, &row);
  if (variant_.destination) {
    row.Add(Vector3d(focus_from_world * WayToDestination(variant_, state)), kNear);
  }
  for (int a = 0; a < ActionSize(skill_); ++a) row.Add(senses.last_action[a]);
}

Vector3d WayTo(const Destination& destination, const SkillVariant& variant,
               const tasks::SceneState& state) {
  Vector3d point = state.goal;
  if (!destination.goal) {
    const auto thing = static_cast<size_t>(destination.thing);
    const std::vector<Isometry3d> poses =
        tasks::LinkPosesOf(variant.model.things[thing], state.joints[thing]);
    point = state.roots[thing] * poses[static_cast<size_t>(destination.link)] * destination.point;
  }
  return point - tasks::LinkPoint(variant.model, state, variant.focus->thing, variant.focus->link);
}

Vector3d WayToDestination(const SkillVariant& variant, const tasks::SceneState& state) {
  return WayTo(*variant.destination, variant, state);
}

}  // namespace simwright::rl
