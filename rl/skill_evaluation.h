#pragma once

#include <cstdint>
#include <vector>

#include "rl/episode.h"
#include "rl/policy.h"
#include "rl/wilson_interval.h"

namespace simwright::rl {

struct EvaluatedEpisode {
  EpisodeStart start;
  EpisodeStart end;  // as the skill after it may begin
  bool success = false;
  double seconds = 0.0;
};

struct SkillEvaluation {
  std::vector<EvaluatedEpisode> episodes;
  int successes = 0;
  Interval interval;     // 95 %, of the success rate
  double seconds = 0.0;  // mean of those that succeeded

  double rate() const {
    return episodes.empty() ? 0.0 : static_cast<double>(successes) / episodes.size();
  }
};

// Lets `policy` act, without drawing, in as many episodes as there are starts. Success: it has held
// for options.hold_seconds at the episode's end. The same starts give the same result for any
// number of threads. Throws core::Error where policy and skill are of other sizes.
SkillEvaluation Evaluate(const Skill& skill, const Policy& policy,
                         const std::vector<EpisodeStart>& starts);

// The same of the script (ScriptedAction). Throws core::Error where there is none.
SkillEvaluation EvaluateScript(const Skill& skill, const std::vector<EpisodeStart>& starts);

// `count` starts of the skill, drawn by `seed`.
std::vector<EpisodeStart> DrawStarts(const Skill& skill, int count, std::uint64_t seed);

// One episode to its end.
EvaluatedEpisode RunEpisode(const Policy& policy, const EpisodeStart& start, Episode* episode);

// The same by the script; its skill must have one.
EvaluatedEpisode RunScript(const EpisodeStart& start, Episode* episode);

// What the episode has come to, as a start: things and arm where they are, at rest.
EpisodeStart EndOf(const Episode& episode);

// Throws core::Error unless the skill has a script (HasScript).
void RequireScript(const Skill& skill);

// Throws core::Error unless the policy sees and does what the skill shows and takes.
void RequireFits(const Policy& policy, const Skill& skill);

}  // namespace simwright::rl
