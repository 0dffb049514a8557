#pragma once

#include <optional>
#include <string>

namespace simwright::rl {

// What the seven numbers of an action say (docs/skills.md).
enum class ActionSpace {
  // Where the tool shall be as seen from what the hand works on: offset, turn, opening.
  kFocus,
  // The same, beside what a script asks for there (ScriptedAction): zero follows the script, what
  // is
  // learnt is where it is wrong (residual learning: Johannink et al. 2019).
  kGuided,
  // The same as seen from the robot: an absolute pose, zero in front of it.
  kAbsolute,
  // How far the tool shall move from where it was last sent to.
  kDelta,
  // Where each of the arm's joints shall move from where it was last sent to; then the opening.
  kJoints,
};

// "focus", "absolute", "delta", "joints", and back. The latter throws core::Error, listing them.
std::string NameOf(ActionSpace space);
ActionSpace ActionSpaceOf(const std::string& name);

// A range that a factor is drawn from, evenly in its logarithm.
struct FactorRange {
  double low = 1.0, high = 1.0;
};

// How a skill is simulated and varied.
struct SkillOptions {
  // Time.
  double control_rate = 60.0;  // Hz: how often the arm gets a new command
  int substeps = 4;            // of the physics in one of them: 240 Hz, Bullet's own rate
  int control_steps = 3;       // in one decision of the policy: 20 Hz, as most manipulation work
  // Doors take 4 s and more. With 5 s in training a policy opened microwaves that it had not seen
  // in 46 % after 168k decisions, with 8 s in 67 % after 184k.
  double episode_seconds = 8.0;
  double hold_seconds = 0.5;  // success that lasts so long ends the episode

  // Physics. A grasp holds 20 N without slip from 20 iterations on (tests/sim/driven_robot_test).
  int contact_iterations = 20;  // while the robot touches something
  int free_iterations = 4;      // else: only the motors are solved
  bool hulls = true;            // things that are only held or pushed collide by their hull

  // Action.
  ActionSpace action = ActionSpace::kFocus;
  // m, of an offset of 1. Exploration draws offsets of a third of it (PpoOptions::initial_std
  // 0.35). With 0.12 and a deviation of 0.6 a policy took an apple in a quarter of the episodes
  // after 276k decisions, so in 86 % after 72k.
  double reach = 0.08;
  double turn = 0.8;  // rad, of a turn of 1
  // m that the hand with kFocus stays back along its own axis while it is off to a side of what it
  // works on: it comes from above or from in front, not across what it shall take. 0: as it asks.
  double standoff = 0.12;
  double delta_share = 0.25;   // of reach and turn: one decision's step with kDelta and kJoints
  double tool_speed = 0.5;     // m/s: a real arm's 1.7 leaves no time to see
  double turn_speed = 2.0;     // rad/s
  double longest_lead = 0.08;  // rad or m that a joint's command may be ahead of the joint: what is
                               // in the way is pushed, not rammed

  // What differs from episode to episode.
  double position_range = 0.15;  // m, in x and y, to each side
  double furniture_yaw = 0.3;    // rad, to each side, of what is held to the world
  bool any_yaw = true;           // of what is free
  double posture_range = 0.1;    // rad, of each of the arm's joints at the start
  FactorRange mass = {0.5, 2.0};
  FactorRange friction = {0.7, 1.3};  // of surfaces
  FactorRange joint = {0.7, 1.4};     // friction and damping of joints
  // Coefficient of the fingers' surfaces; a pair's is the product. None: the robot's own.
  std::optional<FactorRange> finger_friction = std::nullopt;
  int longest_delay = 1;              // control steps that a command comes late, 0 to this

  // Easier starts, as shares of the episodes; none in an evaluation.
  double at_focus_share = 0.35;  // the hand is where it works
  double part_way_share = 0.3;   // the joint has gone part of its way, the thing is held
  // Share of episodes that begin where the skill before has ended, where there is one (T-STAR's).
  double pool_share = 0.7;

  // Reward.
  double success_bonus = 1.0;  // a decision, beside the program's reward
  double discount = 0.98;      // a decision: what the success that ends an episode is worth

  double decision_seconds() const { return control_steps / control_rate; }
  int decisions() const;  // of an episode
  // The same without easier starts.
  SkillOptions ForEvaluation() const;

  bool IsValid(std::string* error) const;
};

}  // namespace simwright::rl
