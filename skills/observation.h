#pragma once

#include <utility>
#include <vector>

#include "skills/skill.h"
#include "skills/tool_command.h"

namespace simwright::skills {

// The policy inputs that are not in the scene state.
struct PolicyInputs {
  const robot::JointVector* arm = nullptr;         // (J)
  const robot::JointVector* velocities = nullptr;  // (J)
  double leader_command = 0.0;
  const float* last_action = nullptr;  // (A)
  // The frame of the actions (GraspPose), world_from_target.
  Eigen::Isometry3d world_from_target = Eigen::Isometry3d::Identity();
  bool at_destination = false;  // the frame is at the destination of a grasped object
  bool retreating = false;      // the frame is the retreat pose (TargetFrame)
};

// Writes the observation in one variant of a skill; all variants have the same size.
class Observer {
 public:
  // Both must outlive the observer.
  Observer(const Skill& skill, const SkillVariant& variant);

  int size() const;
  // Return the joints (object and joint) and the other free objects that the observation contains,
  // in order.
  const std::vector<std::pair<int, int>>& joints() const { return joints_; }
  const std::vector<int>& objects() const { return objects_; }
  // Writes size() numbers of about unit size into `row`: joint positions and velocities of the arm,
  // the gripper in the target frame, that frame in the robot's base, the joints and objects that
  // the program reads, the target's size and motion (TargetGeometry), the displacement to the
  // destination, the last action (docs/skills.md). `previous`: the state one decision before, or
  // null.
  void Write(const tasks::WorldState& state, const tasks::WorldState* previous,
             const PolicyInputs& senses, float* row) const;

 private:
  class Row;
  void AddArm(const PolicyInputs& senses, Row* row) const;
  void AddHand(const tasks::WorldState& state, const PolicyInputs& senses, Row* row) const;
  void AddJoints(const tasks::WorldState& state, const tasks::WorldState* previous, Row* row) const;
  void AddTargetObject(const tasks::WorldState& state, const tasks::WorldState* previous,
                       const Eigen::Matrix3d& target_from_world, Row* row) const;
  void AddTargetGeometry(const tasks::WorldState& state, const Eigen::Isometry3d& world_from_target,
                         Row* row) const;
  void AddObjects(const tasks::WorldState& state, const Eigen::Matrix3d& target_from_world,
                  Row* row) const;

  const Skill& skill_;
  const SkillVariant& variant_;
  std::vector<std::pair<int, int>> joints_;  // object and joint that the program reads
  std::vector<int> objects_;                 // free objects that it reads, other than the target
};

}  // namespace simwright::skills
