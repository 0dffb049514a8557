#pragma once

#include "rl/skill.h"

namespace simwright::rl {

// The frame that a policy sees and acts from, followed through an episode. Its origin and axes are
// where the tool works: at the part or thing, and once a thing is held, where the tool is when the
// thing has come to its destination; what is pushed is worked at from behind, as seen from where it
// shall go. An action of zero so always means "get there".
class FocusFrame {
 public:
  // `state` at the start of the episode, `across` (unit, world) the tool's y axis at work and
  // `pitch` (rad) as PlanReach gives them.
  FocusFrame(const SkillVariant& variant, const tasks::SceneState& state,
             const Eigen::Vector3d& across, double pitch);

  // Follows what has moved since.
  void Update(const tasks::SceneState& state);

  const Eigen::Isometry3d& world_from_focus() const { return world_from_focus_; }
  bool at_destination() const { return at_destination_; }
  // rad that the tool leans about the frame's y axis at work. A hand that pushes leans back while
  // the frame is level: what it is asked for is along the floor.
  double lean() const { return lean_; }
  // The way that a part goes as it is worked, in the focus' frame, unit; zero of what turns in
  // place and of things. A hand that is off the focus on that way is ahead of the part, and at its
  // work.
  const Eigen::Vector3d& free_way() const { return free_way_; }

 private:
  void Switch(const tasks::SceneState& state);

  const SkillVariant& variant_;
  Eigen::Isometry3d world_from_focus_ = Eigen::Isometry3d::Identity();
  Eigen::Vector3d across_;  // unit, world: the tool's y axis at work
  double pitch_ = 0.0, lean_ = 0.0;
  Eigen::Vector3d free_way_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d grip_ = Eigen::Vector3d::Zero();  // m, the thing's frame: where it is taken
  bool at_destination_ = false;
  int held_ = 0;  // updates in a row with the thing in both fingers
};

}  // namespace simwright::rl
