#pragma once

#include <memory>
#include <vector>

#include "rl/initiation_set.h"
#include "rl/skill_evaluation.h"

namespace simwright::rl {

// The next skill of a chain, which assigns a value to the end states of the previous one. Constant
// and thread-safe.
class Successor {
 public:
  // `tried`: evaluated episodes of the next skill from end states of the previous one (Evaluate).
  // Throws core::Error if there are none.
  Successor(std::shared_ptr<const Skill> skill, const std::vector<EvaluatedEpisode>& tried);

  // Returns the success probability, in (0, 1), from an end state (EndOf) of another skill in the
  // same scene.
  double Chance(const EpisodeStart& end) const;

 private:
  std::shared_ptr<const Skill> skill_;
  InitiationSet set_;
};

}  // namespace simwright::rl
