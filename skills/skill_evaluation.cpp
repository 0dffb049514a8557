#include "skills/skill_evaluation.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "skills/episode.h"
#include "skills/observation.h"
#include "skills/scripted_expert.h"
#include "skills/tool_command.h"

namespace simwright::skills {

void RequireFits(const rl::Policy& policy, const Skill& skill) {
  const int observed = Observer(skill, skill.variants.front()).size();
  if (policy.observation_size() == observed && policy.action_size() == ActionSize(skill)) return;
  throw core::Error("the policy has " + std::to_string(policy.observation_size()) + " inputs and " +
                        std::to_string(policy.action_size()) + " outputs, the skill needs " +
                        std::to_string(observed) + " and " + std::to_string(ActionSize(skill)),
                    "subtask " + skill.variants.front().subtask.name,
                    "train it for this task, robot and action space");
}

void RequireScriptedExpert(const Skill& skill) {
  if (HasScriptedExpert(skill)) return;
  throw core::Error(
      "there is no scripted expert for the action space '" + NameOf(skill.options.action) + "'",
      "subtask " + skill.variants.front().subtask.name, "use focus or guided, or a policy");
}

std::vector<StartState> SampleStarts(const Skill& skill, int count, std::uint64_t seed) {
  std::vector<StartState> starts(static_cast<size_t>(count));
  core::ParallelFor(count, [&](int i) {
    core::CheckCancelled();  // thousands of starts take as long as their episodes
    core::Rng rng = core::StreamRng(seed, static_cast<std::uint64_t>(i));
    starts[static_cast<size_t>(i)] = SampleStart(skill, rng);
  });
  return starts;
}

StartState EndOf(const Episode& episode) {
  StartState end = episode.start();
  end.state = episode.state();
  Eigen::VectorXd arm;
  episode.world().robot().Positions(&arm);
  end.arm = arm;
  end.grasp_configuration = arm;
  end.leader = episode.world().robot().Leader();
  end.closed_to.reset();
  end.held = HeldObject(episode.skill().variants[static_cast<size_t>(end.variant)], end.state);
  return end;
}

namespace {

// Runs one episode; `act` writes the next action into a row of ActionSize(skill).
template <typename Act>
EvaluatedEpisode RunWith(const Act& act, const StartState& start, Episode* episode) {
  std::vector<float> action(static_cast<size_t>(ActionSize(episode->skill())));
  EvaluatedEpisode result;
  result.start = start;
  episode->Begin(start);
  Decision decision;
  while (!decision.terminated && !decision.truncated) {
    act(*episode, action.data());
    decision = episode->Step(action.data());
  }
  result.success = decision.terminated;
  result.seconds = episode->seconds();
  result.end = EndOf(*episode);
  return result;
}

// Evaluates `run` (episode, start), which runs one episode.
template <typename Run>
SkillEvaluation EvaluateWith(const Skill& skill, const Run& run,
                             const std::vector<StartState>& starts) {
  SkillEvaluation evaluation;
  evaluation.episodes.resize(starts.size());
  const int threads = core::ThreadCount();
  core::ParallelFor(threads, [&](int thread) {
    Episode episode(skill);
    for (size_t i = static_cast<size_t>(thread); i < starts.size();
         i += static_cast<size_t>(threads)) {
      core::CheckCancelled();
      evaluation.episodes[i] = run(starts[i], &episode);
    }
  });
  for (const EvaluatedEpisode& episode : evaluation.episodes) {
    if (!episode.success) continue;
    ++evaluation.successes;
    evaluation.seconds += episode.seconds;
  }
  if (evaluation.successes > 0) evaluation.seconds /= evaluation.successes;
  evaluation.interval =
      rl::WilsonInterval(evaluation.successes, static_cast<int>(evaluation.episodes.size()));
  return evaluation;
}

}  // namespace

EvaluatedEpisode RunEpisode(const rl::Policy& policy, const StartState& start, Episode* episode) {
  rl::Rows observation(1, policy.observation_size()), action;
  const auto act = [&](const Episode& now, float* next) {
    now.Observe(observation.data());
    policy.Act(observation, &action);
    std::copy_n(action.data(), action.cols(), next);
  };
  return RunWith(act, start, episode);
}

EvaluatedEpisode RunScriptedExpert(const StartState& start, Episode* episode) {
  // With guided actions, zero follows the scripted expert.
  if (episode->skill().options.action == ActionSpace::kGuided) {
    return RunWith([](const Episode&, float* action) { std::fill_n(action, 7, 0.0f); }, start,
                   episode);
  }
  return RunWith(ExpertAction, start, episode);
}

SkillEvaluation Evaluate(const Skill& skill, const rl::Policy& policy,
                         const std::vector<StartState>& starts) {
  RequireFits(policy, skill);
  return EvaluateWith(
      skill,
      [&](const StartState& start, Episode* episode) { return RunEpisode(policy, start, episode); },
      starts);
}

SkillEvaluation EvaluateScriptedExpert(const Skill& skill, const std::vector<StartState>& starts) {
  RequireScriptedExpert(skill);
  return EvaluateWith(skill, RunScriptedExpert, starts);
}

}  // namespace simwright::skills
