#include "skills/observation.h"

#include <algorithm>

#include "manipulation/goal_displacement.h"
#include "manipulation/target_geometry.h"

namespace simwright::skills {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using reward::RewardInput;

constexpr double kObservationNear = 0.1;  // m, unit of distances near the target
constexpr double kRoom = 0.5;             // m, unit of distances in the scene
constexpr double kFast = 2.0;             // rad/s or m/s

constexpr int kHand = 3 + 6 + 4;              // pose; opening, its command, touch, grasp
constexpr int kFrame = 3 + 6 + 1;             // pose; at the destination
constexpr int kJoint = 2;                     // position, velocity
constexpr int kTargetObject = 3 + 3 + 3 + 3;  // position, upright axis, velocity, size
constexpr int kTargetSize = 3;                // in the target frame
constexpr int kTargetPart = 3 + 3 + 3;        // middle, direction of motion, hinge: for joints
constexpr int kOtherObject = 3 + 3 + 3;       // position, upright axis, size
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
  for (const reward::RewardSlot& slot : variant.program->slots()) {
    if (slot.asset.empty()) continue;
    const int object = variant.model.Find(slot.asset);
    const int joint = variant.model.objects[static_cast<size_t>(object)].FindJoint(slot.part);
    if (slot.input == RewardInput::kJointState && joint >= 0) {
      add(&joints_, std::pair<int, int>(object, joint));
    } else if (!variant.fixed[static_cast<size_t>(object)] &&
               (!variant.target || object != variant.target->object)) {
      add(&objects_, object);
    }
  }
}

int Observer::size() const {
  int size = 2 * skill_.robot->arm.size() + kHand + kFrame + ActionSize(skill_);
  size += kJoint * static_cast<int>(joints_.size());
  if (variant_.target) size += kTargetObject + kTargetSize;
  if (variant_.target && variant_.target->joint >= 0) size += kTargetPart;
  size += kOtherObject * static_cast<int>(objects_.size());
  return variant_.destination ? size + kDestination : size;
}

void Observer::AddArm(const PolicyInputs& senses, Row* row) const {
  for (Eigen::Index j = 0; j < senses.arm->size(); ++j) {
    const robot::ArmJoint& joint = skill_.robot->arm.joints[static_cast<size_t>(j)];
    const double middle = 0.5 * (joint.lower + joint.upper);
    row->Add(2.0 * ((*senses.arm)[j] - middle) / (joint.upper - joint.lower));
  }
  for (Eigen::Index j = 0; j < senses.velocities->size(); ++j) {
    row->Add((*senses.velocities)[j] / kFast);
  }
}

void Observer::AddHand(const tasks::WorldState& state, const PolicyInputs& senses, Row* row) const {
  const Isometry3d target_from_tool = senses.world_from_target.inverse() * state.gripper;
  row->Add(Vector3d(target_from_tool.translation()), kObservationNear);
  row->Add(Eigen::Matrix3d(target_from_tool.linear()));
  const robot::Gripper& gripper = skill_.robot->gripper;
  row->Add(2.0 * state.opening / gripper.MaxOpening() - 1.0);
  row->Add(2.0 * gripper.Opening(senses.leader_command) / gripper.MaxOpening() - 1.0);
  const bool touches_target = variant_.target && state.touched == variant_.target->object;
  row->Add(touches_target ? 1.0 : 0.0);
  row->Add(touches_target && state.grasped ? 1.0 : 0.0);
}

void Observer::AddJoints(const tasks::WorldState& state, const tasks::WorldState* previous,
                         Row* row) const {
  for (const auto& [object, joint] : joints_) {
    const auto t = static_cast<size_t>(object), j = static_cast<size_t>(joint);
    const tasks::ObjectJoint& known = variant_.model.objects[t].joints[j];
    const double range = std::max(known.upper - known.lower, 1e-6);
    row->Add(2.0 * (state.joints[t][j] - known.lower) / range - 1.0);
    const double moved = previous ? state.joints[t][j] - previous->joints[t][j] : 0.0;
    row->Add(moved / (range * skill_.options.decision_seconds()));
  }
}

void Observer::AddTargetObject(const tasks::WorldState& state, const tasks::WorldState* previous,
                               const Eigen::Matrix3d& target_from_world, Row* row) const {
  const int object = variant_.target->object;
  const auto t = static_cast<size_t>(object);
  const Vector3d point = tasks::LinkPosition(variant_.model, state, object, 0);
  row->Add(Vector3d(target_from_world * (point - state.gripper.translation())), kObservationNear);
  row->Add(Vector3d(target_from_world * state.roots[t].linear().col(2)), 1.0);
  Vector3d moved = Vector3d::Zero();
  if (previous) moved = point - tasks::LinkPosition(variant_.model, *previous, object, 0);
  row->Add(Vector3d(target_from_world * moved), kRoom * skill_.options.decision_seconds());
  row->Add(Vector3d(variant_.model.objects[t].box.sizes()), kObservationNear);
}

void Observer::AddTargetGeometry(const tasks::WorldState& state,
                                 const Isometry3d& world_from_target, Row* row) const {
  const manipulation::TargetGeometry geometry =
      manipulation::GeometryOf(variant_.model, state, *variant_.target, world_from_target);
  row->Add(geometry.size, kObservationNear);
  if (variant_.target->joint < 0) return;
  row->Add(geometry.middle, kObservationNear);
  row->Add(geometry.motion_direction, 1.0);
  row->Add(geometry.hinge, kRoom);
}

void Observer::AddObjects(const tasks::WorldState& state, const Eigen::Matrix3d& target_from_world,
                          Row* row) const {
  for (const int object : objects_) {
    const auto t = static_cast<size_t>(object);
    const Vector3d point = tasks::LinkPosition(variant_.model, state, object, 0);
    row->Add(Vector3d(target_from_world * (point - state.gripper.translation())), kRoom);
    row->Add(Vector3d(target_from_world * state.roots[t].linear().col(2)), 1.0);
    row->Add(Vector3d(variant_.model.objects[t].box.sizes()), kObservationNear);
  }
}

void Observer::Write(const tasks::WorldState& state, const tasks::WorldState* previous,
                     const PolicyInputs& senses, float* target) const {
  Row row(target);
  AddArm(senses, &row);
  AddHand(state, senses, &row);
  const Isometry3d base_from_target =
      variant_.subtask.start.world_from_robot.inverse() * senses.world_from_target;
  row.Add(Vector3d(base_from_target.translation()), kRoom);
  row.Add(Eigen::Matrix3d(base_from_target.linear()));
  row.Add(senses.retreating ? -1.0 : senses.at_destination ? 1.0 : 0.0);
  AddJoints(state, previous, &row);
  const Eigen::Matrix3d target_from_world = senses.world_from_target.linear().transpose();
  if (variant_.target) {
    AddTargetObject(state, previous, target_from_world, &row);
    AddTargetGeometry(state, senses.world_from_target, &row);
  }
  AddObjects(state, target_from_world, &row);
  if (variant_.destination) {
    row.Add(Vector3d(target_from_world * manipulation::DisplacementToDestination(variant_, state)),
            kObservationNear);
  }
  for (int a = 0; a < ActionSize(skill_); ++a) row.Add(senses.last_action[a]);
}

}  // namespace simwright::skills
