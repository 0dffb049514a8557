#pragma once

#include <cstdint>
#include <vector>

#include "rl/skill_evaluation.h"

namespace simwright::rl {

// One subtask of a task, with what was learnt for it.
struct ChainLink {
  const Skill* skill = nullptr;
  const Policy* policy = nullptr;  // none: the script (rl/scripted_hand.h)
};

struct ChainOutcome {
  std::vector<EvaluatedEpisode> links;  // up to the first that failed
  bool success = false;                 // of all links
};

struct ChainEvaluation {
  std::vector<ChainOutcome> outcomes;
  int successes = 0;
  Interval interval;  // 95 %
  // By link: how often it succeeded where the ones before it had.
  std::vector<int> tried, succeeded;
};

// Runs the links one after the other from `start`, each from where the one before ended, things and
// arm at rest. `rng` draws what Varied draws.
ChainOutcome RunChain(const std::vector<ChainLink>& links, const EpisodeStart& start,
                      core::Rng& rng);

// `count` chains from starts of the first link, drawn by `seed`. Throws core::Error without links,
// or where a policy does not fit its skill or a skill without one has no script.
ChainEvaluation EvaluateChain(const std::vector<ChainLink>& links, int count, std::uint64_t seed);

}  // namespace simwright::rl
