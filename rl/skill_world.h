#pragma once

#include <memory>
#include <vector>

#include "rl/episode_start.h"
#include "sim/articulated_world.h"
#include "sim/driven_robot.h"

namespace simwright::rl {

// The world of one episode: the start's things and the robot. Reads what the physics did as a
// SceneState. One thread at a time.
class SkillWorld {
 public:
  // `skill` and `variant` must outlive the world.
  SkillWorld(const Skill& skill, const EpisodeStart& start);

  sim::DrivenRobot& robot() { return *robot_; }
  const sim::DrivenRobot& robot() const { return *robot_; }

  // One control step: the physics' substeps with the robot's command as it is.
  void Advance();
  // Into `state`, whose memory is used again; `goal` is left as it is. `touched` is what the
  // fingers touch, `grasped` whether both press on it.
  void Read(tasks::SceneState* state) const;
  // Whether each number of the state is finite and no thing is faster or farther than things get.
  bool IsSound() const;
  bool touching() const { return touching_; }

 private:
  void CloseOn(int thing, double leader);
  void ReadContacts();

  const Skill& skill_;
  const SkillVariant& variant_;
  sim::ArticulatedWorld world_;
  std::unique_ptr<sim::DrivenRobot> robot_;
  std::vector<int> bodies_;    // by thing; -1: not in the world
  std::vector<int> thing_of_;  // by body; -1: the robot
  std::vector<sim::LinkContact> contacts_;
  std::vector<double> pressed_[2];  // by finger: N s on each thing in the last substep
  int touched_ = -1, touched_link_ = -1;
  bool grasped_ = false;
  bool touching_ = false;  // something in the world touches what the robot can move, or the robot
};

}  // namespace simwright::rl
