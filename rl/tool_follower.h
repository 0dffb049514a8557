#pragma once

#include "rl/skill.h"

namespace simwright::rl {

// Predicts the configurations of an arm whose tool follows poses, with the inverse kinematics
// tracker of training: continuous in every joint.
class ToolFollower {
 public:
  static constexpr double kTurned = 0.15;  // rad, default orientation tolerance
  // Begins at `from` (J). Skill and variant must outlive this.
  ToolFollower(const Skill& skill, const SkillVariant& variant, const robot::Posture& from);

  // Moves the tool straight to `world_from_tool`. Returns true if it arrives within 1 cm and
  // `turned` (rad).
  bool Goes(const Eigen::Isometry3d& world_from_tool, double turned = kTurned);
  const robot::Posture& posture() const { return posture_; }  // (J) the current one

 private:
  const Skill& skill_;
  Eigen::Isometry3d base_from_world_;
  robot::Posture step_;
  robot::Posture posture_;
};

}  // namespace simwright::rl
