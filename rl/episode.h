#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "rl/episode_start.h"
#include "rl/focus_frame.h"
#include "rl/observation.h"
#include "rl/skill_world.h"
#include "rl/tool_command.h"
#include "rl/variant_reward.h"
#include "rl/work_postures.h"

namespace simwright::rl {

// What one decision led to.
struct Decision {
  float reward = 0.0f;
  bool success = false;     // now
  bool terminated = false;  // success has held for options.hold_seconds
  bool truncated = false;   // time is out, or the physics has failed
  bool failed = false;      // the physics has
};

// One episode of a skill: a world, and what goes between it and a policy. Mutable; one thread at a
// time. Repeats itself bit for bit from the same start and actions.
class Episode {
 public:
  // `skill` must outlive the episode.
  explicit Episode(const Skill& skill);
  ~Episode();

  void Begin(const EpisodeStart& start);
  // `action` (A), clamped to [-1, 1].
  Decision Step(const float* action);
  // Called after each control step from then on; may be empty.
  void Watch(std::function<void(const Episode&)> watch) { watch_ = std::move(watch); }
  // Into `row`, as Observer says.
  void Observe(float* row) const;

  // As it was begun, but for what is planned: where a plan has ended early, another follows.
  const EpisodeStart& start() const { return start_; }
  const tasks::SceneState& state() const { return state_; }
  const SkillWorld& world() const { return *world_; }
  const FocusFrame& frame() const { return *frame_; }
  const ArmCommand& command() const { return command_; }
  const Skill& skill() const { return skill_; }
  bool succeeding() const { return held_ > 0; }  // at the last decision
  double seconds() const { return decisions_ * skill_.options.decision_seconds(); }  // since Begin

 private:
  struct Program;
  void FollowPlan();
  bool IsAtPlansEnd() const;
  void PlanAnew();
  void Act(const ToolTarget& target);
  float Reward(bool* success);
  void PlanArrival();
  void RestAsPlanned();

  const Skill& skill_;
  std::vector<std::unique_ptr<Program>> programs_;  // by variant, made when first used
  EpisodeStart start_;
  std::unique_ptr<SkillWorld> world_;
  std::unique_ptr<FocusFrame> frame_;
  tasks::SceneState state_, previous_;
  robot::Posture arm_, velocities_;
  ArmCommand command_;
  WorkPostures along_;      // of the joint that is worked on
  robot::Posture arrival_;  // (J) before a destination that was planned for; else empty
  Eigen::VectorXd positions_;
  ToolTarget target_;
  std::vector<float> action_, guided_;  // (A) the policy's, and with the script's
  std::function<void(const Episode&)> watch_;
  int decisions_ = 0;
  int plans_ = 0;  // that were followed
  int held_ = 0;   // decisions in a row with success
};

}  // namespace simwright::rl
