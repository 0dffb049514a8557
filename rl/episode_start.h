#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/random.h"
#include "rl/detour.h"
#include "rl/skill.h"

namespace simwright::rl {

// How an episode begins.
struct EpisodeStart {
  int variant = 0;
  tasks::SceneState state;  // things and joints; the gripper's part is not used
  robot::Posture arm;       // (J)
  double leader = 0.0;      // of the gripper's first joint
  double pitch = 0.0;       // of the hand at work, and the arm's posture there (PlanReach)
  robot::Posture at_work;
  // m, world: how far an empty hand gets away from where another skill has left it, before it goes
  // to its work (FocusFrame). Zero: it does not.
  Eigen::Vector3d withdraw = Eigen::Vector3d::Zero();
  // (J) that the arm then goes through, where the straight way to its work is not clear.
  Detour via;
  int held = -1;  // the thing that the hand closes on before the episode begins; -1: none
  // How far the hand, at work, closes before the episode begins: the gripper's first joint, where
  // nothing between the fingers stops it. Easier starts have it.
  std::optional<double> closed_to;
  std::vector<double> mass;  // factors, by thing
  std::vector<double> friction;
  std::vector<double> joint;  // of friction and damping of joints
  int delay = 0;              // control steps
  std::optional<double> finger_friction;  // of the fingers' surfaces; none: the robot's own
};

// Draws a start of the skill: one of its variants, its things moved and turned within the options'
// ranges such that nothing overlaps, the arm is in none of them and can do its work there
// (PlanReach), joints and hand as the shares of easier starts say. Falls back on the start as
// described where no such place is found in 60 tries, the later of which move everything away from
// the robot by up to 0.4 m, or towards it by up to 0.2. Where the skill begins a task, what comes
// later is within the arm's reach too (IsLaterWorkInReach), if such a place is found.
EpisodeStart DrawStart(const Skill& skill, core::Rng& rng);

// The thing that both fingers hold and that moves with them: no furniture. -1: none.
int HeldThing(const SkillVariant& variant, const tasks::SceneState& state);

enum class VariedParts {
  kEverything,  // masses, frictions, delay drawn again, the arm moved a little if it is empty
  kNothing,     // only the work is planned anew
};

// `start` as one of this skill: it may be where another skill of the same scene has ended. The work
// is planned from there.
EpisodeStart Varied(const Skill& skill, const EpisodeStart& start, core::Rng& rng,
                    VariedParts parts = VariedParts::kEverything);

}  // namespace simwright::rl
