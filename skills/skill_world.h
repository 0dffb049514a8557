#pragma once

#include <memory>
#include <vector>

#include "sim/articulated_world.h"
#include "sim/driven_robot.h"
#include "skills/episode_start.h"

namespace simwright::skills {

// The world of one episode: the objects of its start state and the robot. Reads the state of the
// physics as a WorldState. One thread at a time.
class SkillWorld {
 public:
  // `skill` and `variant` must outlive the world.
  SkillWorld(const Skill& skill, const StartState& start);

  sim::DrivenRobot& robot() { return *robot_; }
  const sim::DrivenRobot& robot() const { return *robot_; }

  // Runs one control step: the physics' substeps with the robot's current command.
  void Advance();
  // Writes into `state`, reusing its memory; `goal` is left unchanged. `touched` is the object in
  // contact with the fingers, `grasped` is true if both press on it.
  void Read(tasks::WorldState* state) const;
  // Returns true if the state is finite and all objects are within a bounded distance of the robot.
  bool IsStateValid() const;
  bool touching() const { return touching_; }

 private:
  int ContactIterations(const StartState& start) const;
  void CloseGripperOn(int object, double leader);
  void ReadContacts();

  const Skill& skill_;
  const SkillVariant& variant_;
  int contact_iterations_;  // of the solver, while the robot is in contact
  sim::ArticulatedWorld world_;
  std::unique_ptr<sim::DrivenRobot> robot_;
  std::vector<int> bodies_;     // by object; -1: not in the world
  std::vector<int> object_of_;  // by body; -1: the robot
  std::vector<sim::LinkContact> contacts_;
  std::vector<double> finger_impulses_[2];  // by finger: N s on each object in the last substep
  int touched_ = -1, touched_link_ = -1;
  bool grasped_ = false;
  bool touching_ = false;  // the robot touches an object, the floor or itself
};

}  // namespace simwright::skills
