#pragma once

#include "manipulation/interaction.h"

namespace simwright::manipulation {

// The frame in which a policy observes and acts, tracked through an episode. Its pose is the grasp
// pose at the target; once the object is grasped, the tool pose with the object at its destination;
// for a pushed object, a pose behind it as seen from its destination. An action of zero thus always
// means "go to the target". After another skill the frame is first the retreat pose, until the
// gripper has retreated.
class TargetFrame {
 public:
  // `state`: at the start of the episode; `across` (unit, world): the closing axis, tool y; `pitch`
  // (rad): the approach pitch, and `grasp` (ReachPlan::grasp), from PlanReach; `retreat` (m,
  // world): the retreat displacement.
  TargetFrame(const Interaction& interaction, const tasks::WorldState& state,
              const Eigen::Vector3d& across, double pitch,
              const Eigen::Vector3d& retreat = Eigen::Vector3d::Zero(), int grasp = -1);

  // Rotates the frame at the destination, and with it the direction of approach, by `angle` (rad)
  // about the vertical.
  void Turn(double angle, const tasks::WorldState& state);

  // Tracks the motion since the last call.
  void Update(const tasks::WorldState& state);

  const Eigen::Isometry3d& world_from_target() const { return world_from_target_; }
  bool at_destination() const { return at_destination_; }
  bool retreating() const { return retreating_; }
  // Returns the lean (rad) of the tool about the frame's y axis at the target. A pushing gripper
  // leans back while the frame stays level, so that actions are along the floor.
  double lean() const { return retreating_ ? 0.0 : lean_; }
  // Returns the direction in which the part moves as it is manipulated (unit, target frame); zero
  // for parts that rotate in place and for free objects. A gripper displaced along it is ahead of
  // the part and still at its target.
  Eigen::Vector3d motion_direction() const {
    return retreating_ ? Eigen::Vector3d::Zero() : free_way_;
  }
  // ActionFrame::back and room_depth: out of the receptacle that contains the frame or the target
  // object; over the rim at a destination in a top-opening receptacle.
  const Eigen::Vector3d& back() const { return back_; }
  double retreat_distance() const { return retreat_distance_; }

 private:
  void UpdateAtDestination(const tasks::WorldState& state);
  void Follow(const tasks::WorldState& state);
  void FollowGrasp(const tasks::WorldState& state);
  void UpdateGraspPoint(const tasks::WorldState& state);
  Eigen::Quaterniond Uprighting(const tasks::WorldState& state) const;
  Eigen::Vector3d PlaceAtDestination(const tasks::WorldState& state,
                                     const Eigen::Vector3d& grasp) const;
  bool Withdraws(const tasks::WorldState& state);
  Eigen::Isometry3d NextOfRetreat(const tasks::WorldState& state) const;
  void ComputeRetreat(const tasks::WorldState& state);

  const Interaction& interaction_;
  Eigen::Isometry3d world_from_target_ = Eigen::Isometry3d::Identity();
  Eigen::Vector3d across_;  // unit, world: the closing axis
  double pitch_ = 0.0, lean_ = 0.0;
  int grasp_ = -1;  // index into InteractionTarget::grasps
  Eigen::Vector3d free_way_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d grasp_point_ = Eigen::Vector3d::Zero();  // m, object frame: the grasp point
  bool at_destination_ = false;
  double below_ = 0.0;  // m, from the object's middle to its lowest point
  int held_ = 0;        // consecutive updates with the object in both fingers
  bool was_held_ = false;
  int updates_at_rest_ = 0;  // consecutive updates at rest at the frame, grasping the object
  Eigen::Vector3d back_ = -Eigen::Vector3d::UnitZ();
  double retreat_distance_ = 0.0;
  bool retreating_ = false;
  double smallest_distance_ = 1e9;                             // m from the retreat pose
  int updates_stuck_ = 0;                                      // updates without progress
  int updates_withdrawing_ = 0;                                // updates of the retreat
  Eigen::Isometry3d retreat_ = Eigen::Isometry3d::Identity();  // world_from_tool, the retreat pose
  Eigen::Isometry3d before_ = Eigen::Isometry3d::Identity();   // world_from_tool, at the start
  int updates_opening_ = 0;                                    // updates while it opens
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();         // of the frame at the target
};

}  // namespace simwright::manipulation
