#pragma once

#include <memory>
#include <vector>

#include "rl/initiation_set.h"
#include "skills/skill_evaluation.h"

namespace simwright::skills {

// The next skill of a chain, which assigns a value to the end states of the previous one. Constant
// and thread-safe.
class NextSkill {
 public:
  // `tried`: evaluated episodes of the next skill from end states of the previous one (Evaluate).
  // Throws core::Error if there are none.
  NextSkill(std::shared_ptr<const Skill> skill, const std::vector<EvaluatedEpisode>& tried);

  // Returns the success probability, in (0, 1), from an end state (EndOf) of another skill in the
  // same scene.
  double SuccessProbability(const StartState& end) const;

 private:
  std::shared_ptr<const Skill> skill_;
  rl::InitiationSet set_;
};

}  // namespace simwright::skills
