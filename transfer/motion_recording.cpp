#include "transfer/motion_recording.h"

#include <iterator>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "skills/start_pool.h"
#include "workflows/skills/skill_motion.h"

namespace simwright::transfer {
namespace {

// The largest speed-ups over the recording, as `simwright export` tries them.
constexpr double kPaces[] = {100.0, 2.0, 1.0};
// The stream of the worlds in which motions are compared: others than those of the check.
constexpr std::uint64_t kChoiceWorlds = 0x5e1ec7ull;

std::vector<workflows::RunSkill> SkillsWithin(
    const TransferTask& task, const std::map<std::string, skills::PlacementRange>& ranges) {
  workflows::SkillRun run = task.run();
  run.randomized = true;
  run.options.placement_ranges = ranges;
  return workflows::PrepareSkills(run);
}

std::vector<skills::ChainLink> LinksOf(const std::vector<workflows::RunSkill>& skills,
                                       const std::vector<rl::Policy>& policies) {
  std::vector<skills::ChainLink> links;
  for (size_t k = 0; k < skills.size(); ++k) {
    links.push_back({skills[k].evaluated.get(), &policies[k]});
  }
  return links;
}

std::map<std::string, skills::PlacementRange> Zero(
    std::map<std::string, skills::PlacementRange> ranges) {
  for (auto& [asset, range] : ranges) range = {};
  return ranges;
}

}  // namespace

MotionRecorder::MotionRecorder(const TransferTask& task, const std::vector<rl::Policy>& policies,
                               const std::map<std::string, skills::PlacementRange>& ranges)
    : task_(task),
      described_(SkillsWithin(task, Zero(ranges))),
      displaced_(SkillsWithin(task, ranges)),
      described_links_(LinksOf(described_, policies)),
      displaced_links_(LinksOf(displaced_, policies)) {}

std::optional<TransferMotion> MotionRecorder::MotionAt(
    double pace, const workflows::ChainRecording& recording,
    const std::vector<workflows::RunSkill>& skills, std::uint64_t seed) const {
  robot::RetimingOptions options;
  options.max_speed_up = pace;
  TransferMotion motion;
  try {
    workflows::SkillMotion made =
        workflows::MotionOf(recording, *skills.front().evaluated, options);
    workflows::SkillMetadata metadata = workflows::MetadataOf(task_.run(), skills, recording, seed);
    metadata.times = made.subtasks;
    motion.trajectory = std::move(made.retimed.trajectory);
    motion.trajectory.metadata = workflows::MetadataLines(metadata);
    motion.times = metadata.times;
    motion.start = metadata.start;
    motion.where = "motion " + std::to_string(recording.episode);
  } catch (const core::Error&) {  // the retimer found no motion at this pace
    return std::nullopt;
  }
  if (!task_.Replays(task_.described(), motion)) return std::nullopt;
  return motion;
}

std::vector<TransferMotion> MotionRecorder::Record(std::uint64_t seed,
                                                   std::uint64_t episode) const {
  const bool displaced = episode % 2 == 1;
  const workflows::ChainRecording recording =
      workflows::RecordEpisode(displaced ? displaced_links_ : described_links_, seed, episode);
  std::vector<TransferMotion> motions;
  if (!recording.success) return motions;
  const std::vector<workflows::RunSkill>& skills = displaced ? displaced_ : described_;
  for (const double pace : kPaces) {
    const bool recorded = pace == kPaces[std::size(kPaces) - 1];
    if (!motions.empty() && !recorded) continue;
    auto motion = MotionAt(pace, recording, skills, seed);
    if (motion) motions.push_back(std::move(*motion));
  }
  return motions;
}

ChosenMotion ChooseMotion(const MotionRecorder& recorder, const TransferTask& task,
                          const PerturbedTwin& twin, int episodes, int worlds, std::uint64_t seed,
                          core::Progress* progress) {
  std::vector<std::vector<TransferMotion>> recorded(static_cast<size_t>(episodes));
  progress->Stage("record motions", episodes);
  core::ParallelFor(episodes, [&](int i) {
    core::CheckCancelled();
    recorded[static_cast<size_t>(i)] = recorder.Record(seed, static_cast<std::uint64_t>(i));
    progress->Advance();
  });
  ChosenMotion chosen;
  chosen.episodes = episodes;
  for (const auto& motions : recorded) chosen.recorded += !motions.empty();
  progress->Stage("try motions in perturbed twins", chosen.recorded);
  bool first_described = false;
  for (size_t i = 0; i < recorded.size(); ++i) {
    for (const TransferMotion& motion : recorded[i]) {
      const TransferRate rate = RateAt(
          [&](double scale, std::uint64_t index) {
            return task.Replays(twin.World(scale, seed ^ kChoiceWorlds, index), motion);
          },
          1.0, worlds);
      const bool described = i % 2 == 0;
      if (chosen.first.worlds == 0 || (described && !first_described)) {
        chosen.first = rate;
        chosen.first_motion = motion;
        first_described = described;
      }
      if (chosen.rate.worlds > 0 && rate.successes <= chosen.rate.successes) continue;
      chosen.rate = rate;
      chosen.motion = motion;
    }
    if (!recorded[i].empty()) progress->Advance();
  }
  if (chosen.recorded > 0) return chosen;
  throw core::Error("none of " + std::to_string(episodes) +
                        " episodes gives a motion that succeeds in the twin itself",
                    task.run().folder.string(), "train longer, or try another --seed");
}

}  // namespace simwright::transfer
