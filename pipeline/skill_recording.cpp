#include "pipeline/skill_recording.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/random.h"

namespace simwright::pipeline {
namespace {

constexpr int kTriesForEach = 20;

RecordedMoment MomentOf(const rl::Episode& episode) {
  RecordedMoment moment;
  moment.state = episode.state();
  episode.world().Read(&moment.state);
  const sim::DrivenRobot& robot = episode.world().robot();
  robot.Positions(&moment.arm);
  moment.leader = robot.Leader();
  moment.arm_command = robot.command();
  moment.leader_command = robot.leader_command();
  return moment;
}

std::vector<float> List(const rl::Rows& row) {
  return {row.data(), row.data() + row.size()};
}

RecordedSubtask RecordSubtask(const rl::ChainLink& link, const rl::EpisodeStart& start,
                              rl::Episode* episode) {
  RecordedSubtask recorded;
  recorded.start = start;
  episode->Begin(start);
  recorded.moments.push_back(MomentOf(*episode));
  episode->Watch([&](const rl::Episode& now) { recorded.moments.push_back(MomentOf(now)); });
  rl::Rows observation(1, link.policy->observation_size()), action;
  rl::Decision decision;
  episode->Observe(observation.data());
  while (!decision.terminated && !decision.truncated) {
    RecordedDecision& step = recorded.decisions.emplace_back();
    step.observation = List(observation);
    link.policy->Act(observation, &action);
    step.action = List(action);
    decision = episode->Step(action.data());
    step.reward = decision.reward;
    step.done = decision.terminated || decision.truncated;
    episode->Observe(observation.data());
    step.next_observation = List(observation);
  }
  episode->Watch({});
  recorded.success = decision.terminated;
  return recorded;
}

}  // namespace

ChainRecording RecordEpisode(const std::vector<rl::ChainLink>& links, std::uint64_t seed,
                             std::uint64_t number) {
  core::Rng rng = core::StreamRng(seed, number);
  ChainRecording recording;
  recording.episode = number;
  rl::EpisodeStart next = rl::DrawStart(*links.front().skill, rng);
  for (size_t i = 0; i < links.size(); ++i) {
    if (i > 0) next = rl::Varied(*links[i].skill, next, rng, rl::VariedParts::kNothing);
    rl::Episode episode(*links[i].skill);
    recording.subtasks.push_back(RecordSubtask(links[i], next, &episode));
    if (!recording.subtasks.back().success) return recording;
    next = rl::EndOf(episode);
  }
  recording.success = true;
  return recording;
}

std::vector<ChainRecording> RecordSuccesses(const std::vector<rl::ChainLink>& links, int count,
                                            std::uint64_t seed, int* tried) {
  if (links.empty()) throw core::Error("a chain needs a link");
  for (const rl::ChainLink& link : links) rl::RequireFits(*link.policy, *link.skill);
  std::vector<ChainRecording> successes;
  const int batch = 2 * core::ThreadCount();
  for (*tried = 0; static_cast<int>(successes.size()) < count;) {
    core::CheckCancelled();
    if (*tried >= kTriesForEach * count) {
      throw core::Error("only " + std::to_string(successes.size()) + " of " +
                            std::to_string(*tried) + " episodes succeeded, " +
                            std::to_string(count) + " were asked for",
                        "", "train it longer, or ask for fewer --episodes");
    }
    std::vector<ChainRecording> recordings(static_cast<size_t>(batch));
    core::ParallelFor(batch, [&](int i) {
      recordings[static_cast<size_t>(i)] =
          RecordEpisode(links, seed, static_cast<std::uint64_t>(*tried + i));
    });
    for (ChainRecording& recording : recordings) {
      if (static_cast<int>(successes.size()) == count) break;
      ++*tried;
      if (recording.success) successes.push_back(std::move(recording));
    }
  }
  return successes;
}

}  // namespace simwright::pipeline
