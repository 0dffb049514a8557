#pragma once

#include <utility>
#include <vector>

#include "rl/skill.h"
#include "rl/tool_command.h"

namespace simwright::rl {

// What a policy sees, besides what the scene's state says.
struct Senses {
  const robot::Posture* arm = nullptr;         // (J)
  const robot::Posture* velocities = nullptr;  // (J)
  double leader_command = 0.0;
  const float* last_action = nullptr;  // (A)
  // The frame that actions are seen from (ToolAtFocus), world_from_focus.
  Eigen::Isometry3d world_from_focus = Eigen::Isometry3d::Identity();
  bool at_destination = false;  // that frame is where a held thing goes
  bool withdrawing = false;     // that frame is where the hand gets away to (FocusFrame)
};

// Writes what a policy sees in one variant of a skill; other variants give as many numbers.
class Observer {
 public:
  // Both must outlive the observer.
  Observer(const Skill& skill, const SkillVariant& variant);

  int size() const;
  // Into `row`, size() numbers of about unit size: joints and speeds of the arm, the hand as the
  // focus frame sees it, that frame as the robot sees it, the joints and things that the program
  // reads, how large what the hand works on is and where it can go (FocusGeometry), the way to the
  // destination, the last action (docs/skills.md). `previous`: the state one
  // decision before, or null.
  void Write(const tasks::SceneState& state, const tasks::SceneState* previous,
             const Senses& senses, float* row) const;

 private:
  class Row;
  void AddArm(const Senses& senses, Row* row) const;
  void AddHand(const tasks::SceneState& state, const Senses& senses, Row* row) const;
  void AddJoints(const tasks::SceneState& state, const tasks::SceneState* previous, Row* row) const;
  void AddFocusThing(const tasks::SceneState& state, const tasks::SceneState* previous,
                     const Eigen::Matrix3d& focus_from_world, Row* row) const;
  void AddFocusGeometry(const tasks::SceneState& state, const Eigen::Isometry3d& world_from_focus,
                        Row* row) const;
  void AddThings(const tasks::SceneState& state, const Eigen::Matrix3d& focus_from_world,
                 Row* row) const;

  const Skill& skill_;
  const SkillVariant& variant_;
  std::vector<std::pair<int, int>> joints_;  // thing and joint that the program reads
  std::vector<int> things_;                  // free ones that it reads, other than the focus
};

// The way that the thing at work still has to go to `destination`, m, world.
Eigen::Vector3d WayTo(const Destination& destination, const SkillVariant& variant,
                      const tasks::SceneState& state);

// The same to its own destination.
Eigen::Vector3d WayToDestination(const SkillVariant& variant, const tasks::SceneState& state);

}  // namespace simwright::rl
