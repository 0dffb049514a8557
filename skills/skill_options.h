#pragma once

#include <map>
#include <optional>
#include <string>

namespace simwright::skills {

// The meaning of the seven numbers of an action (docs/skills.md).
enum class ActionSpace {
  // The tool pose relative to the interaction target: offset, rotation, opening.
  kTargetFrame,
  // The same, added to the scripted expert's action (ExpertAction): zero follows the expert, and
  // the policy learns a correction (residual learning: Johannink et al. 2019).
  kGuided,
  // The tool pose in the robot's base frame: absolute, zero in front of the robot.
  kAbsolute,
  // The displacement of the tool from its last command.
  kDelta,
  // The displacement of each arm joint from its last command; then the opening.
  kJoints,
  // The position of each arm joint: -1 is its lower limit, 1 its upper one; then the opening.
  kJointTargets,
};

// Returns "focus", "guided", "absolute", "delta", "joints", "joint_targets", and the inverse. The
// latter throws core::Error, listing them.
std::string NameOf(ActionSpace space);
ActionSpace ActionSpaceOf(const std::string& name);

// Returns true for the spaces whose actions are about arm joints.
bool CommandsJoints(ActionSpace space);
// Returns true for the spaces in which the arm follows a planned path around obstacles until its
// last waypoint. In the others the action alone moves the arm.
bool FollowsPlan(ActionSpace space);

// The range of a factor that is sampled uniformly in its logarithm.
struct FactorRange {
  double low = 1.0, high = 1.0;
};

// The range of an object's placement about the described one, to each side.
struct PlacementRange {
  double position = 0.0;  // m, in x and y
  double yaw = 0.0;       // rad
};

// The simulation and randomization options of a skill.
struct SkillOptions {
  // Time.
  double control_rate = 60.0;  // Hz, of arm commands
  int substeps = 4;            // of the physics per command: 240 Hz, Bullet's own rate
  int control_steps = 3;       // per decision of the policy: 20 Hz, as in most manipulation work
  // Doors take 4 s and more; with 5 s in training a policy opens fewer unseen microwaves.
  double episode_seconds = 8.0;
  double hold_seconds = 0.5;  // success held this long ends the episode

  // Physics. A grasp holds 20 N without slip from 20 iterations on (tests/sim/driven_robot_test).
  int contact_iterations = 20;  // while the robot is in contact
  // The same while a free object lighter than `light_mass` (kg) is in the scene: with 20 iterations
  // the fingers sink into an object of 10 g, and it slips out
  // (tests/skills/proved_grasps_test).
  int light_contact_iterations = 60;
  double light_mass = 0.05;
  int free_iterations = 4;  // else: only the motors are solved
  bool hulls = true;        // objects that are only grasped or pushed collide by their hull

  // Action.
  ActionSpace action = ActionSpace::kTargetFrame;
  // m, for an offset of 1. Exploration samples offsets of about a third of it
  // (PpoOptions::initial_std 0.35); larger ones slow learning.
  double reach = 0.08;
  double turn = 0.8;  // rad, for a rotation of 1
  // The distance (m) that the gripper with kTargetFrame stays back along its own axis while it is
  // laterally off the target: it approaches from above or from the front, not across the target.
  // 0: no standoff.
  double standoff = 0.12;
  double delta_share = 0.25;  // of reach and turn: one decision's step with kDelta and kJoints
  double tool_speed = 0.5;    // m/s: a real arm's 1.7 leaves no time to react
  double turn_speed = 2.0;    // rad/s
  // The lead (rad or m) that a joint's command may have over the joint: obstacles are pushed, not
  // rammed.
  double longest_lead = 0.08;

  // Randomization between episodes.
  double position_range = 0.15;  // m, in x and y, to each side
  double furniture_yaw = 0.3;    // rad, to each side, of fixed objects
  bool any_yaw = true;           // of free objects
  // The ranges of single objects, by asset, in place of the three above; those of the others are
  // then zero, the objects keep their distance from the robot, and objects whose bounding boxes
  // overlap as described may do so. Empty: the three above apply to all.
  std::map<std::string, PlacementRange> placement_ranges;
  double configuration_range = 0.1;  // rad, of each of the arm's joints at the start
  FactorRange mass = {0.5, 2.0};
  FactorRange friction = {0.7, 1.3};  // of surfaces
  FactorRange joint = {0.7, 1.4};     // friction and damping of joints
  // The coefficient of the finger surfaces; that of a contact is the product of both sides. None:
  // the robot's own.
  std::optional<FactorRange> finger_friction = std::nullopt;
  int longest_delay = 1;  // control steps that a command is delayed, 0 to this

  // Easier start states, as shares of the episodes; none in an evaluation.
  double at_target_share = 0.35;   // the gripper is at its target
  double partly_open_share = 0.3;  // the joint is part of its way open, the object is grasped
  // The share of episodes that begin at an end state of the previous skill, if there are any
  // (T-STAR's).
  double pool_share = 0.7;

  // Reward.
  double success_bonus = 1.0;  // per decision, beside the program's reward
  double discount = 0.98;      // per decision: the value of the success that ends an episode

  double decision_seconds() const { return control_steps / control_rate; }
  int decisions() const;  // of an episode
  // Returns the same options without easier start states.
  SkillOptions ForEvaluation() const;
  // Returns the same options with every quantity as described: places of objects, masses,
  // frictions (of the fingers: the robot's own), the arm at the start, no delay.
  SkillOptions WithoutRandomization() const;

  bool IsValid(std::string* error) const;
};

}  // namespace simwright::skills
