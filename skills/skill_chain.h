#pragma once

#include <cstdint>
#include <vector>

#include "skills/skill_evaluation.h"

namespace simwright::skills {

// One subtask of a task, with the policy that was trained for it.
struct ChainLink {
  const Skill* skill = nullptr;
  const rl::Policy* policy = nullptr;  // none: the scripted expert (rl/scripted_hand.h)
};

struct ChainOutcome {
  std::vector<EvaluatedEpisode> links;  // up to the first that failed
  bool success = false;                 // all links succeeded
};

struct ChainEvaluation {
  std::vector<ChainOutcome> outcomes;
  int successes = 0;
  rl::Interval interval;  // 95 %
  // By link: the number of attempts and of successes, after all previous links had succeeded.
  std::vector<int> tried, succeeded;
};

// Runs the links in order from `start`, each from the end state of the previous one with objects
// and arm at rest. `rng` is passed to Varied.
ChainOutcome RunChain(const std::vector<ChainLink>& links, const StartState& start, core::Rng& rng);

// Runs `count` chains from start states of the first link that are sampled with `seed`. Throws
// core::Error if there are no links, if a policy does not fit its skill, or if a skill without a
// policy has no scripted expert.
ChainEvaluation EvaluateChain(const std::vector<ChainLink>& links, int count, std::uint64_t seed);

}  // namespace simwright::skills
