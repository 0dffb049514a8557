#pragma once

#include "rl/skill.h"

namespace simwright::rl {

// The frame that a policy sees and acts from, followed through an episode. Its origin and axes are
// where the tool works: at the part or thing, and once a thing is held, where the tool is when the
// thing has come to its destination; what is pushed is worked at from behind, as seen from where it
// shall go. An action of zero so always means "get there". A hand that begins where another skill
// has left it first gets away from there: until it has, the frame is where it gets away to.
class FocusFrame {
 public:
  // `state` at the start of the episode, `across` (unit, world) the tool's y axis at work and
  // `pitch` (rad) as PlanReach gives them, `withdraw` (m, world) how far the hand gets away first.
  FocusFrame(const SkillVariant& variant, const tasks::SceneState& state,
             const Eigen::Vector3d& across, double pitch,
             const Eigen::Vector3d& withdraw = Eigen::Vector3d::Zero());

  // Turns the frame at the destination, and with it how the hand comes there, by `angle` (rad)
  // about the upright.
  void Turn(double angle, const tasks::SceneState& state);

  // Follows what has moved since.
  void Update(const tasks::SceneState& state);

  const Eigen::Isometry3d& world_from_focus() const { return world_from_focus_; }
  bool at_destination() const { return at_destination_; }
  bool withdrawing() const { return withdrawing_; }
  // rad that the tool leans about the frame's y axis at work. A hand that pushes leans back while
  // the frame is level: what it is asked for is along the floor.
  double lean() const { return withdrawing_ ? 0.0 : lean_; }
  // The way that a part goes as it is worked, in the focus' frame, unit; zero of what turns in
  // place and of things. A hand that is off the focus on that way is ahead of the part, and at its
  // work.
  Eigen::Vector3d free_way() const { return withdrawing_ ? Eigen::Vector3d::Zero() : free_way_; }
  // WorkFrame::back and room_depth: out of the room that the frame, or the thing at work, is in; at
  // a destination in a room that opens upwards, over its rim.
  const Eigen::Vector3d& back() const { return back_; }
  double room_depth() const { return room_depth_; }

 private:
  void Switch(const tasks::SceneState& state);
  void Follow(const tasks::SceneState& state);
  void GripAnew(const tasks::SceneState& state);
  bool Withdraws(const tasks::SceneState& state);
  void FindWayIn(const tasks::SceneState& state);

  const SkillVariant& variant_;
  Eigen::Isometry3d world_from_focus_ = Eigen::Isometry3d::Identity();
  Eigen::Vector3d across_;  // unit, world: the tool's y axis at work
  double pitch_ = 0.0, lean_ = 0.0;
  Eigen::Vector3d free_way_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d grip_ = Eigen::Vector3d::Zero();  // m, the thing's frame: where it is taken
  bool at_destination_ = false;
  double below_ = 0.0;  // m, how far the thing reaches below its middle
  int held_ = 0;        // updates in a row with the thing in both fingers
  bool was_held_ = false;
  int resting_ = 0;  // updates in a row that the hand, holding it, is where it shall be
  Eigen::Vector3d back_ = -Eigen::Vector3d::UnitZ();
  double room_depth_ = 0.0;
  bool withdrawing_ = false;
  double nearest_ = 1e9;                                      // m from there, so far
  int stuck_ = 0;                                             // updates without coming nearer
  int withdrawn_ = 0;                                         // updates that it has gone on for
  Eigen::Isometry3d refuge_ = Eigen::Isometry3d::Identity();  // world_from_tool, to get away to
  Eigen::Isometry3d before_ = Eigen::Isometry3d::Identity();  // world_from_tool, at the start
  int opens_ = 0;                                             // updates that it has waited there
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();        // of the frame at work
};

}  // namespace simwright::rl
