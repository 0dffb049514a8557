#pragma once

#include "rl/skill.h"

namespace simwright::rl {

// Looks ahead where an arm comes to when its tool follows poses, with the tracker that training
// uses: from posture to posture, with the jumps of none of its joints.
class ToolFollower {
 public:
  static constexpr double kTurned = 0.15;  // rad that a tool may be turned where it has come to
  // Begins at `from` (J). Skill and variant must outlive this.
  ToolFollower(const Skill& skill, const SkillVariant& variant, const robot::Posture& from);

  // Goes straight to `world_from_tool`. Whether the tool gets there, off by no more than a
  // centimetre and `turned` (rad).
  bool Goes(const Eigen::Isometry3d& world_from_tool, double turned = kTurned);
  const robot::Posture& posture() const { return posture_; }  // (J) where it has come to

 private:
  const Skill& skill_;
  Eigen::Isometry3d base_from_world_;
  robot::Posture step_;
  robot::Posture posture_;
};

}  // namespace simwright::rl
