#include "rl/focus_frame.h"

#include <cmath>

#include "rl/focus_geometry.h"
#include "rl/observation.h"
#include "rl/reach_plan.h"

namespace simwright::rl {
namespace {

using Eigen::Vector3d;

constexpr int kSurelyHeld = 3;     // updates
constexpr double kLost = 0.06;     // m between the tool and the grasp point: no longer in the hand
constexpr double kInPlace = 0.03;  // m from its axis: what is nearer turns in place

// FocusFrame::free_way, with the frame at `world_from_focus`.
Vector3d FreeWay(const SkillVariant& variant, const tasks::SceneState& state,
                 const Eigen::Isometry3d& world_from_focus) {
  const Focus& focus = *variant.focus;
  if (focus.joint < 0) return Vector3d::Zero();
  const auto thing = static_cast<size_t>(focus.thing), j = static_cast<size_t>(focus.joint);
  const tasks::ThingJoint& joint = variant.model.things[thing].joints[j];
  const FocusGeometry geometry = GeometryOf(variant.model, state, focus, world_from_focus);
  const bool turns = joint.type != tasks::RewardJointType::kPrismatic;
  if (turns && geometry.hinge.norm() < kInPlace) return Vector3d::Zero();
  const double described = variant.start.joints[thing][j];
  return WorkEnd(joint, described) > described ? geometry.way : Vector3d(-geometry.way);
}

}  // namespace

FocusFrame::FocusFrame(const SkillVariant& variant, const tasks::SceneState& state,
                       const Vector3d& across, double pitch)
    : variant_(variant), across_(across) {
  if (!variant_.focus) return;
  (Pushes(variant_) ? lean_ : pitch_) = pitch;
  world_from_focus_ = ToolAtFocus(variant_, state, across_, pitch_);
  across_ = world_from_focus_.linear().col(1);
  const Eigen::Isometry3d& root = state.roots[static_cast<size_t>(variant_.focus->thing)];
  grip_ = root.inverse() * world_from_focus_.translation();
  at_destination_ = variant_.starts_held;
  free_way_ = FreeWay(variant_, state, world_from_focus_);
  Update(state);
}

void FocusFrame::Switch(const tasks::SceneState& state) {
  const bool held = state.grasped && state.touched == variant_.focus->thing;
  held_ = held ? held_ + 1 : 0;
  if (held_ >= kSurelyHeld) at_destination_ = true;
  const Vector3d grasp = state.roots[static_cast<size_t>(variant_.focus->thing)] * grip_;
  const bool lost = (grasp - state.gripper.translation()).norm() > kLost;
  if (lost && !variant_.starts_held) at_destination_ = false;
}

void FocusFrame::Update(const tasks::SceneState& state) {
  if (!variant_.focus) return;
  const Focus& focus = *variant_.focus;
  if (focus.joint >= 0 || Pushes(variant_)) {
    world_from_focus_ = ToolAtFocus(variant_, state, across_, pitch_);
    across_ = world_from_focus_.linear().col(1);
    return;
  }
  if (variant_.destination && variant_.asks_for_grasp) Switch(state);
  world_from_focus_.translation() = state.roots[static_cast<size_t>(focus.thing)] * grip_;
  if (at_destination_) world_from_focus_.translation() += WayToDestination(variant_, state);
}

}  // namespace simwright::rl
