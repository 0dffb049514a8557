#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "manipulation/path_configurations.h"
#include "manipulation/target_frame.h"
#include "skills/episode_start.h"
#include "skills/observation.h"
#include "skills/skill_world.h"
#include "skills/tool_command.h"
#include "skills/variant_reward.h"

namespace simwright::skills {

// The outcome of one decision.
struct Decision {
  float reward = 0.0f;
  bool success = false;         // in the current state
  bool terminated = false;      // success has held for options.hold_seconds
  bool truncated = false;       // the time limit is reached, or the episode has failed
  bool failed = false;          // the physics has failed, or the action was invalid
  bool invalid_action = false;  // the action was not finite; the world has not moved
};

// One episode of a skill: a world and the interface between it and a policy. Mutable; one thread at
// a time. The same start state and actions give bit-identical episodes.
class Episode {
 public:
  // `skill` must outlive the episode.
  explicit Episode(const Skill& skill);
  ~Episode();

  void Begin(const StartState& start);
  // Executes `action` (A), clamped to [-1, 1]. An action that is not finite fails the episode.
  Decision Step(const float* action);
  // Sets a function that is called after each control step; may be empty.
  void SetStepListener(std::function<void(const Episode&)> watch) { watch_ = std::move(watch); }
  // Writes the observation into `row` (Observer).
  void Observe(float* row) const;

  bool begun() const { return world_ != nullptr; }  // the rest needs an episode that has begun
  // Returns the start state of the episode. Its plan is replaced when the episode replans.
  const StartState& start() const { return start_; }
  const tasks::WorldState& state() const { return state_; }
  const SkillWorld& world() const { return *world_; }
  const manipulation::TargetFrame& frame() const { return *frame_; }
  const ArmCommand& command() const { return command_; }
  const Skill& skill() const { return skill_; }
  bool succeeding() const { return held_ > 0; }  // at the last decision
  double seconds() const { return decisions_ * skill_.options.decision_seconds(); }  // since Begin

 private:
  struct Program;
  void StartPlan();
  bool IsAtPlansEnd() const;
  void Replan();
  void Act(const ToolTarget& target);
  float Reward(bool* success);
  void PlanArrival();
  void UpdateRestConfiguration();

  const Skill& skill_;
  std::vector<std::unique_ptr<Program>> programs_;  // by variant, made when first used
  StartState start_;
  std::unique_ptr<SkillWorld> world_;
  std::unique_ptr<manipulation::TargetFrame> frame_;
  tasks::WorldState state_, previous_;
  robot::JointVector arm_, velocities_;
  ArmCommand command_;
  manipulation::PathConfigurations along_;  // configurations along the target joint's path
  robot::JointVector arrival_;              // (J) before a planned destination; else empty
  Eigen::VectorXd positions_;
  ToolTarget target_;
  std::vector<float> action_, combined_action_;  // (A) the expert's added to the second
  std::function<void(const Episode&)> watch_;
  int decisions_ = 0;
  int plan_count_ = 0;  // plans followed so far
  int held_ = 0;        // consecutive decisions with success
};

}  // namespace simwright::skills
