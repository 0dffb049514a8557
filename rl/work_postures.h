#pragma once

#include <vector>

#include "rl/skill.h"

namespace simwright::rl {

// Postures of an arm that moves a joint's part along its way, with the tool at the focus.
struct WorkPostures {
  std::vector<double> positions;         // rad or m, of the joint, from where it stands on
  std::vector<robot::Posture> postures;  // (J) one for each
  bool ends_early = false;               // the tool does not go all of the joint's way

  // Between the two nearest; the first or last beyond them. Requires at least one.
  robot::Posture At(double position) const;
};

// Those that follow each other from `at_work` (J), of a hand that leans by `pitch` (rad), as a plan
// has looked at them (PlanReach): as far as the tool can go. Empty where the skill works on no
// joint, or the tool is not at its focus in `at_work`.
WorkPostures PosturesAlong(const Skill& skill, const SkillVariant& variant, tasks::SceneState state,
                           const robot::Posture& at_work, double pitch);

}  // namespace simwright::rl
