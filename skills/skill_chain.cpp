#include "skills/skill_chain.h"

#include <memory>

#include "core/error.h"
#include "core/parallel.h"
#include "skills/episode.h"

namespace simwright::skills {

ChainOutcome RunChain(const std::vector<ChainLink>& links, const StartState& start,
                      core::Rng& rng) {
  ChainOutcome outcome;
  StartState next = start;
  for (size_t i = 0; i < links.size(); ++i) {
    const ChainLink& link = links[i];
    if (i > 0) next = PlannedFrom(*link.skill, next, rng, Resampling::kNothing);
    Episode episode(*link.skill);
    outcome.links.push_back(link.policy ? RunEpisode(*link.policy, next, &episode)
                                        : RunScriptedExpert(next, &episode));
    if (!outcome.links.back().success) return outcome;
    next = outcome.links.back().end;
  }
  outcome.success = true;
  return outcome;
}

ChainEvaluation EvaluateChain(const std::vector<ChainLink>& links, int count, std::uint64_t seed) {
  if (links.empty()) throw core::Error("a chain needs a link");
  for (const ChainLink& link : links) {
    if (link.policy) {
      RequireFits(*link.policy, *link.skill);
    } else {
      RequireScriptedExpert(*link.skill);
    }
  }
  ChainEvaluation evaluation;
  evaluation.outcomes.resize(static_cast<size_t>(count));
  core::ParallelFor(count, [&](int i) {
    core::Rng rng = core::StreamRng(seed, static_cast<std::uint64_t>(i));
    const StartState start = SampleStart(*links.front().skill, rng);
    evaluation.outcomes[static_cast<size_t>(i)] = RunChain(links, start, rng);
  });
  evaluation.tried.assign(links.size(), 0);
  evaluation.succeeded.assign(links.size(), 0);
  for (const ChainOutcome& outcome : evaluation.outcomes) {
    evaluation.successes += outcome.success;
    for (size_t k = 0; k < outcome.links.size(); ++k) {
      ++evaluation.tried[k];
      evaluation.succeeded[k] += outcome.links[k].success;
    }
  }
  evaluation.interval = rl::WilsonInterval(evaluation.successes, count);
  return evaluation;
}

}  // namespace simwright::skills
