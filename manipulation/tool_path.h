#pragma once

#include "manipulation/interaction.h"

namespace simwright::manipulation {

// Predicts the configurations of an arm whose tool follows poses, with the inverse kinematics
// tracker of training: continuous in every joint.
class CartesianFollower {
 public:
  static constexpr double kTurned = 0.15;  // rad, default orientation tolerance
  // Begins at `from` (J). The arm and the interaction must outlive this.
  CartesianFollower(const PlanningArm& context, const Interaction& interaction,
                    const robot::JointVector& from);

  // Moves the tool straight to `world_from_tool`. Returns true if it arrives within 1 cm and
  // `turned` (rad).
  bool MoveTo(const Eigen::Isometry3d& world_from_tool, double turned = kTurned);
  const robot::JointVector& configuration() const { return configuration_; }  // (J) the current one

 private:
  const PlanningArm& context_;
  Eigen::Isometry3d base_from_world_;
  robot::JointVector step_;
  robot::JointVector configuration_;
};

}  // namespace simwright::manipulation
