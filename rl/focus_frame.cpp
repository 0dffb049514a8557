#include "rl/focus_frame.h"

#include <cmath>

#include "rl/observation.h"
#include "rl/reach_plan.h"

namespace simwright::rl {
namespace {

using Eigen::Vector3d;

constexpr int kSurelyHeld = 3;  // updates
constexpr double kLost = 0.06;  // m between the tool and the grasp point: no longer in the hand

// What is pushed is seen along the way that it shall go.
void FaceDestination(const SkillVariant& variant, const tasks::SceneState& state,
                     Eigen::Isometry3d* world_from_focus) {
  Vector3d way = WayToDestination(variant, state);
  way.z() = 0.0;
  if (way.norm() < 1e-3) return;
  const Vector3d along = way.normalized(), down = -Vector3d::UnitZ();
  world_from_focus->linear() << along, down.cross(along), down;
}

}  // namespace

FocusFrame::FocusFrame(const SkillVariant& variant, const tasks::SceneState& state, double pitch)
    : variant_(variant), tool_yaw_(ToolYaw(state.gripper)), pitch_(pitch) {
  if (!variant_.focus) return;
  world_from_focus_ = ToolAtFocus(variant_, state, tool_yaw_, pitch_);
  tool_yaw_ = ToolYaw(world_from_focus_);
  const bool pushes = variant_.focus->joint < 0 && variant_.destination && !variant_.asks_for_grasp;
  if (pushes) FaceDestination(variant_, state, &world_from_focus_);
  at_destination_ = variant_.starts_held;
  Update(state);
}

void FocusFrame::Switch(const tasks::SceneState& state) {
  const bool held = state.grasped && state.touched == variant_.focus->thing;
  held_ = held ? held_ + 1 : 0;
  if (held_ >= kSurelyHeld) at_destination_ = true;
  const Vector3d grasp = state.roots[static_cast<size_t>(variant_.focus->thing)] *
                         variant_.focus->link_from_tool.translation();
  const bool lost = (grasp - state.gripper.translation()).norm() > kLost;
  if (lost && !variant_.starts_held) at_destination_ = false;
}

void FocusFrame::Update(const tasks::SceneState& state) {
  if (!variant_.focus) return;
  const Focus& focus = *variant_.focus;
  if (focus.joint >= 0) {
    world_from_focus_ = ToolAtFocus(variant_, state, tool_yaw_, pitch_);
    tool_yaw_ = ToolYaw(world_from_focus_);
    return;
  }
  if (variant_.destination && variant_.asks_for_grasp) Switch(state);
  world_from_focus_.translation() =
      state.roots[static_cast<size_t>(focus.thing)] * focus.link_from_tool.translation();
  if (at_destination_) world_from_focus_.translation() += WayToDestination(variant_, state);
}

}  // namespace simwright::rl
