#include "rl/skill_evaluation.h"

#include "core/error.h"
#include "core/parallel.h"
#include "rl/observation.h"

namespace simwright::rl {

void RequireFits(const Policy& policy, const Skill& skill) {
  const int observed = Observer(skill, skill.variants.front()).size();
  if (policy.observation_size() == observed && policy.action_size() == ActionSize(skill)) return;
  throw core::Error("the policy takes " + std::to_string(policy.observation_size()) +
                        " numbers and gives " + std::to_string(policy.action_size()) +
                        ", the skill has " + std::to_string(observed) + " and " +
                        std::to_string(ActionSize(skill)),
                    "subtask " + skill.variants.front().subtask.name,
                    "train it for this task, robot and action space");
}

std::vector<EpisodeStart> DrawStarts(const Skill& skill, int count, std::uint64_t seed) {
  std::vector<EpisodeStart> starts(static_cast<size_t>(count));
  core::ParallelFor(count, [&](int i) {
    core::Rng rng = core::StreamRng(seed, static_cast<std::uint64_t>(i));
    starts[static_cast<size_t>(i)] = DrawStart(skill, rng);
  });
  return starts;
}

EpisodeStart EndOf(const Episode& episode) {
  EpisodeStart end = episode.start();
  end.state = episode.state();
  Eigen::VectorXd arm;
  episode.world().robot().Positions(&arm);
  end.arm = arm;
  end.at_work = arm;
  end.leader = episode.world().robot().Leader();
  end.closed_to.reset();
  end.held = HeldThing(episode.skill().variants[static_cast<size_t>(end.variant)], end.state);
  return end;
}

EvaluatedEpisode RunEpisode(const Policy& policy, const EpisodeStart& start, Episode* episode) {
  Rows observation(1, policy.observation_size()), action;
  EvaluatedEpisode result;
  result.start = start;
  episode->Begin(start);
  Decision decision;
  while (!decision.terminated && !decision.truncated) {
    episode->Observe(observation.data());
    policy.Act(observation, &action);
    decision = episode->Step(action.data());
  }
  result.success = decision.terminated;
  result.seconds = episode->seconds();
  result.end = EndOf(*episode);
  return result;
}

SkillEvaluation Evaluate(const Skill& skill, const Policy& policy,
                         const std::vector<EpisodeStart>& starts) {
  RequireFits(policy, skill);
  SkillEvaluation evaluation;
  evaluation.episodes.resize(starts.size());
  const int threads = core::ThreadCount();
  core::ParallelFor(threads, [&](int thread) {
    Episode episode(skill);
    for (size_t i = static_cast<size_t>(thread); i < starts.size();
         i += static_cast<size_t>(threads)) {
      evaluation.episodes[i] = RunEpisode(policy, starts[i], &episode);
    }
  });
  for (const EvaluatedEpisode& episode : evaluation.episodes) {
    if (!episode.success) continue;
    ++evaluation.successes;
    evaluation.seconds += episode.seconds;
  }
  if (evaluation.successes > 0) evaluation.seconds /= evaluation.successes;
  evaluation.interval =
      WilsonInterval(evaluation.successes, static_cast<int>(evaluation.episodes.size()));
  return evaluation;
}

}  // namespace simwright::rl
