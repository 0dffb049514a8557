#pragma once

#include <cstdint>
#include <vector>

#include "rl/policy.h"
#include "rl/wilson_interval.h"
#include "skills/episode_start.h"

namespace simwright::skills {

class Episode;

struct EvaluatedEpisode {
  StartState start;
  StartState end;  // a start state for the next skill
  bool success = false;
  double seconds = 0.0;
};

struct SkillEvaluation {
  std::vector<EvaluatedEpisode> episodes;
  int successes = 0;
  rl::Interval interval;  // 95 %, of the success rate
  double seconds = 0.0;   // mean over the successes

  double rate() const {
    return episodes.empty() ? 0.0 : static_cast<double>(successes) / episodes.size();
  }
};

// Runs the mean action of `policy` from each start state. An episode succeeds if success has held
// for options.hold_seconds at its end. The results do not depend on the number of threads. Throws
// core::Error if policy and skill have different sizes.
SkillEvaluation Evaluate(const Skill& skill, const rl::Policy& policy,
                         const std::vector<StartState>& starts);

// Evaluates the scripted expert (ExpertAction). Throws core::Error if there is none.
SkillEvaluation EvaluateScriptedExpert(const Skill& skill, const std::vector<StartState>& starts);

// Samples `count` start states of the skill with `seed`. Throws core::Cancelled.
std::vector<StartState> SampleStarts(const Skill& skill, int count, std::uint64_t seed);

// Runs one episode to its end.
EvaluatedEpisode RunEpisode(const rl::Policy& policy, const StartState& start, Episode* episode);

// Runs one episode by the scripted expert; the skill must have one.
EvaluatedEpisode RunScriptedExpert(const StartState& start, Episode* episode);

// Returns the final state of the episode as a start state: objects and arm in place, at rest.
StartState EndOf(const Episode& episode);

// Throws core::Error unless the skill has a scripted expert (HasScriptedExpert).
void RequireScriptedExpert(const Skill& skill);

// Throws core::Error unless the observation and action sizes of policy and skill match.
void RequireFits(const rl::Policy& policy, const Skill& skill);

}  // namespace simwright::skills
