#pragma once

#include <memory>
#include <vector>

#include "rl/initiation_set.h"
#include "rl/skill_evaluation.h"

namespace simwright::rl {

// The skill that follows another in a chain, as the other one sees it: what an end is worth.
// Constant; safe from several threads.
class Successor {
 public:
  // `tried`: episodes of the successor (Evaluate, from where the other one has ended). Throws
  // core::Error where there are none.
  Successor(std::shared_ptr<const Skill> skill, const std::vector<EvaluatedEpisode>& tried);

  // Of success from where another skill of the same scene has ended (EndOf), in (0, 1).
  double Chance(const EpisodeStart& end) const;

 private:
  std::shared_ptr<const Skill> skill_;
  InitiationSet set_;
};

}  // namespace simwright::rl
