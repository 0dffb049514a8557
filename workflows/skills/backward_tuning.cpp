#include "workflows/skills/backward_tuning.h"

#include <atomic>

#include "core/files.h"
#include "core/json.h"
#include "core/parallel.h"
#include "rl/policy_file.h"
#include "rl/training.h"
#include "skills/next_skill.h"
#include "skills/skill_chain.h"
#include "workflows/skills/subtask_training.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr const char* kTunedFile = "backward.json";
constexpr const char* kBeforeFile = "policy_before.pt";
// The smallest reward share of a success, even one whose end is useless to the successor. Without
// it a policy whose ends are all bad would forget how to succeed before it finds better ones.
constexpr double kLeastShare = 0.2;

// Counts the successful chains of both skills.
int SuccessesOfBoth(const TunedPair& pair, const rl::Policy& first, const rl::Policy& second,
                    const std::vector<skills::StartState>& starts) {
  const std::vector<skills::ChainLink> links = {{pair.first->evaluated.get(), &first},
                                                {pair.second->evaluated.get(), &second}};
  std::atomic<int> successes = 0;
  core::ParallelFor(static_cast<int>(starts.size()), [&](int i) {
    core::Rng rng = core::StreamRng(1, static_cast<std::uint64_t>(i));
    successes += skills::RunChain(links, starts[static_cast<size_t>(i)], rng).success;
  });
  return successes;
}

core::Json TextOf(const BackwardTuning& tuning) {
  return {{"samples", tuning.samples},
          {"seconds", tuning.seconds},
          {"before", tuning.before},
          {"after", tuning.after},
          {"kept", tuning.kept}};
}

}  // namespace

std::optional<BackwardTuning> ReadBackwardTuning(const RunSkill& first) {
  const fs::path file = first.folder / kTunedFile;
  if (!fs::exists(file)) return std::nullopt;
  const core::JsonDocument document =
      core::JsonDocument::Read(file, 1 << 20, "remove it to tune the skill again");
  const core::JsonField text = document.root();
  BackwardTuning tuning;
  tuning.samples = text["samples"].Integer();
  tuning.seconds = text["seconds"].Number();
  tuning.before = text["before"].Number();
  tuning.after = text["after"].Number();
  tuning.kept = text["kept"].Flag();
  return tuning;
}

BackwardTuning TuneBackward(const TrainRequest& request, const SkillRun& run, const TunedPair& pair,
                            core::Progress* progress) {
  if (const auto tried = ReadBackwardTuning(*pair.first)) return *tried;
  const RunSkill& first = *pair.first;
  // If an interrupted run had already replaced the policy, the previous one lies beside it.
  const bool replaced = fs::exists(first.folder / kBeforeFile);
  const rl::Policy before =
      rl::ReadPolicy(first.folder / (replaced ? kBeforeFile : rl::kPolicyFile));
  const rl::Policy second = rl::ReadPolicy(pair.second->folder / rl::kPolicyFile);
  const skills::NextSkill successor(pair.second->evaluated, pair.second_tried);
  skills::SkillEnvironment environment(first.skill, run.environments, pair.pool);
  environment.ScaleTerminalRewards([&](const skills::StartState& end) {
    return kLeastShare + (1.0 - kLeastShare) * successor.SuccessProbability(end);
  });
  rl::TrainingOptions options = OptionsFor(request, run, first);
  options.begin_from = first.folder / rl::kCheckpointFile;
  options.ppo.imitated_samples = 0;
  options.max_samples = request.backward_samples;
  options.max_seconds = 0.0;
  options.examine_from = 0.0;
  options.title = first.name + " for " + pair.second->name;
  const auto examined = ExaminationStarts(*first.evaluated, pair.pool, request.seed + 10);
  progress->Stage("tune " + first.name + " for " + pair.second->name);
  const fs::path folder = first.folder / "backward";
  const rl::TrainingResult result = rl::TrainPolicy(
      &environment, options, folder, true,
      [&](const rl::TrainingRecord& record) {
        RequireValidPhysics(environment, first.name, record.samples);
        ReportProgress(record, options, progress);
      },
      [&](const rl::Policy& policy) {
        return rl::Examination{SuccessesOfBoth(pair, policy, second, examined),
                               static_cast<int>(examined.size())};
      });
  const rl::Policy after = rl::ReadPolicy(folder / rl::kPolicyFile);
  progress->Stage("evaluate " + first.name);
  const auto fresh = ExaminationStarts(*first.evaluated, pair.pool, request.seed + 20);
  const auto rate = [&](const rl::Policy& policy) {
    return static_cast<double>(SuccessesOfBoth(pair, policy, second, fresh)) /
           static_cast<double>(fresh.size());
  };
  BackwardTuning tuning;
  tuning.samples = static_cast<std::int64_t>(result.last.samples);
  tuning.seconds = result.last.seconds;
  tuning.before = rate(before);
  tuning.after = rate(after);
  tuning.kept = tuning.after > tuning.before;
  if (tuning.kept) {
    rl::WritePolicy(before, first.folder / kBeforeFile);
    rl::WritePolicy(after, first.folder / rl::kPolicyFile);
  }
  core::WriteFile(first.folder / kTunedFile, core::JsonText(TextOf(tuning)));
  return tuning;
}

}  // namespace simwright::workflows
