#include "workflows/skills/skill_recording.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/random.h"
#include "sim/driven_robot.h"
#include "skills/episode.h"

namespace simwright::workflows {
namespace {

constexpr int kTriesForEach = 20;

RecordedMoment MomentOf(const skills::Episode& episode) {
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

RecordedSubtask RecordSubtask(const skills::ChainLink& link, const skills::StartState& start,
                              skills::Episode* episode) {
  RecordedSubtask recorded;
  recorded.start = start;
  episode->Begin(start);
  recorded.moments.push_back(MomentOf(*episode));
  episode->SetStepListener(
      [&](const skills::Episode& now) { recorded.moments.push_back(MomentOf(now)); });
  rl::Rows observation(1, link.policy->observation_size()), action;
  skills::Decision decision;
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
  episode->SetStepListener({});
  recorded.success = decision.terminated;
  return recorded;
}

[[noreturn]] void RecordingError(const RecordingTally& tally, int count, size_t kept) {
  const std::string of = std::to_string(tally.succeeded) + " of " + std::to_string(tally.tried) +
                         " episodes succeeded";
  const bool lost = static_cast<int>(kept) < tally.succeeded;
  throw core::Error(lost ? of + ", and " + std::to_string(kept) +
                               " of them reproduced their task, " + std::to_string(count) +
                               " were requested"
                         : "only " + of + ", " + std::to_string(count) + " were requested",
                    "", "train longer, or request fewer --episodes");
}

}  // namespace

ChainRecording RecordEpisode(const std::vector<skills::ChainLink>& links, std::uint64_t seed,
                             std::uint64_t number) {
  core::Rng rng = core::StreamRng(seed, number);
  ChainRecording recording;
  recording.episode = number;
  skills::StartState next = skills::SampleStart(*links.front().skill, rng);
  for (size_t i = 0; i < links.size(); ++i) {
    if (i > 0) next = skills::PlannedFrom(*links[i].skill, next, rng, skills::Resampling::kNothing);
    skills::Episode episode(*links[i].skill);
    recording.subtasks.push_back(RecordSubtask(links[i], next, &episode));
    if (!recording.subtasks.back().success) return recording;
    next = skills::EndOf(episode);
  }
  recording.success = true;
  return recording;
}

std::vector<ChainRecording> RecordSuccesses(const std::vector<skills::ChainLink>& links, int count,
                                            std::uint64_t seed, RecordingTally* tally,
                                            const KeepRecording& keep, core::Progress* progress) {
  if (links.empty()) throw core::Error("a chain needs a link");
  for (const skills::ChainLink& link : links) skills::RequireFits(*link.policy, *link.skill);
  std::vector<ChainRecording> kept;
  const int batch = 2 * core::ThreadCount();
  for (*tally = {}; static_cast<int>(kept.size()) < count;) {
    core::CheckCancelled();
    if (tally->tried >= kTriesForEach * count) RecordingError(*tally, count, kept.size());
    std::vector<ChainRecording> recordings(static_cast<size_t>(batch));
    std::vector<char> keeps(recordings.size());
    core::ParallelFor(batch, [&](int i) {
      const auto b = static_cast<size_t>(i);
      recordings[b] = RecordEpisode(links, seed, static_cast<std::uint64_t>(tally->tried + i));
      keeps[b] = recordings[b].success && (!keep || keep(recordings[b]));
    });
    for (size_t b = 0; b < recordings.size() && static_cast<int>(kept.size()) < count; ++b) {
      ++tally->tried;
      tally->succeeded += recordings[b].success;
      if (!keeps[b]) continue;
      kept.push_back(std::move(recordings[b]));
      if (progress) progress->Advance();
    }
  }
  return kept;
}

}  // namespace simwright::workflows
