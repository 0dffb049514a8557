#include "workflows/skills/subtask_training.h"

#include <algorithm>
#include <cstdio>

#include "core/device_choice.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "rl/policy_file.h"
#include "rl/training.h"
#include "skills/scripted_expert.h"
#include "skills/skill_environment.h"
#include "workflows/skills/rank_training.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr const char* kDoneFile = "trained.json";
// The number of episodes of an examination, which takes four seconds on two cores. 124 successes
// give an interval whose lower bound is above 0.92, the default target.
constexpr int kExamined = 128;

Trained ReadTrained(const fs::path& file) {
  const core::JsonDocument document =
      core::JsonDocument::Read(file, 1 << 20, "remove it to continue the training");
  const core::JsonField text = document.root();
  Trained trained;
  trained.samples = text["samples"].Integer();
  trained.seconds = text["seconds"].Number();
  trained.learnt = text["learnt"].Flag();
  if (text.Has("imitated")) trained.shares.imitated = text["imitated"].Integer();
  if (text.Has("critic_alone")) trained.shares.critic_alone = text["critic_alone"].Integer();
  return trained;
}

// Returns true if the request allows more samples and time than the subtask has used.
bool HasBudget(const TrainRequest& request, const Trained& before) {
  return before.samples < request.samples &&
         (request.minutes == 0.0 || before.seconds < 60.0 * request.minutes);
}

// Returns the end of the batch in which `bound` decisions are reached.
std::int64_t BatchEnd(std::int64_t bound, std::int64_t batch) {
  return (bound + batch - 1) / batch * batch;
}

}  // namespace

double TimeLeft(const rl::TrainingRecord& record, const rl::TrainingOptions& options) {
  const double wanted = static_cast<double>(options.max_samples) - record.samples;
  // The elapsed time includes that of examinations.
  const double left = std::max(0.0, wanted) * record.seconds / std::max(1.0, record.samples);
  if (options.max_seconds == 0.0) return left;
  return std::min(left, std::max(0.0, options.max_seconds - record.seconds));
}

void ReportProgress(const rl::TrainingRecord& record, const rl::TrainingOptions& options,
                    core::Progress* progress) {
  char text[96];
  const int length =
      std::snprintf(text, sizeof(text), "%.0fk of %.0fk decisions", 1e-3 * record.samples,
                    1e-3 * static_cast<double>(options.max_samples));
  if (record.episodes > 0.0) {
    std::snprintf(text + length, sizeof(text) - static_cast<size_t>(length), ", %.0f %% succeed",
                  100.0 * record.success);
  }
  progress->Say(text, TimeLeft(record, options));
}

LearningShares SharesOf(std::int64_t samples, const rl::PpoOptions& options, int environments,
                        skills::ActionSpace action) {
  const std::int64_t batch = static_cast<std::int64_t>(options.horizon) * environments;
  LearningShares shares;
  if (action ==
      skills::ActionSpace::kTargetFrame) {  // the action space that SkillEnvironment demonstrates
    shares.imitated = std::min(samples, BatchEnd(options.imitated_samples, batch));
  }
  // Both learn from a batch that ends beyond the bound.
  shares.critic_alone = std::min(samples, options.critic_samples / batch * batch);
  return shares;
}

rl::TrainingOptions OptionsFor(const TrainRequest& request, const SkillRun& run,
                               const RunSkill& skill) {
  rl::TrainingOptions options;
  // The networks are small: a GPU only on request.
  options.ppo.cuda = core::ChosenDevice() == core::DeviceChoice::kCuda;
  options.ppo.discount = run.options.discount;
  // These values, with a discount of 0.98, learn faster and generalise better than shorter horizons
  // and smaller minibatches, and than longer horizons and larger minibatches with a discount of
  // 0.97.
  options.ppo.horizon = 64;
  options.ppo.epochs = 5;
  options.ppo.minibatch = 1024;
  options.ppo.target_kl = 0.02;
  // A zero action already moves to the interaction target, and random actions knock objects over,
  // even more so with a known script.
  const bool scripted = run.options.action == skills::ActionSpace::kGuided ||
                        (request.imitated_samples > 0 && skills::HasScriptedExpert(*skill.skill));
  options.ppo.initial_std = scripted ? 0.15 : 0.35;
  if (run.options.action == skills::ActionSpace::kGuided) {
    // Guided learning only has to correct the scripted expert, so exploration is small: more of it
    // loses grasps. A policy that is worse than the expert is not kept.
    options.ppo.initial_std = 0.05;
    options.examine_from = 0.0;
    options.ppo.critic_samples = 5 * options.ppo.horizon * run.environments;
    options.ppo.learning_rate = 3e-4;
  }
  options.ppo.imitated_samples = request.imitated_samples;
  options.ppo.seed = request.seed;
  options.max_samples = request.samples;
  options.max_seconds = 60.0 * request.minutes;
  options.success_target = request.target;
  options.metadata = {{"task", run.set.tasks.front().name},
                      {"subtask", skill.name},
                      {"robot", run.robot},
                      {"action", skills::NameOf(run.options.action)},
                      {"proved_grasps", run.proved_grasps ? "true" : "false"}};
  options.title = skill.name;
  return options;
}

void RequireValidPhysics(const skills::SkillEnvironment& environment, const std::string& subtask,
                         double samples) {
  const std::int64_t failures = environment.failures();
  if (failures <= 1 || static_cast<double>(failures) <= 1e-5 * samples) return;
  throw core::Error("the physics failed in " + std::to_string(failures) + " of " +
                        std::to_string(static_cast<std::int64_t>(samples)) +
                        " decisions, the last in " + environment.LastFailure(),
                    "subtask " + subtask, "check its assets with `simwright check`");
}

std::vector<skills::StartState> ExaminationStarts(const skills::Skill& skill,
                                                  const std::vector<skills::StartState>& pool,
                                                  std::uint64_t seed) {
  std::vector<skills::StartState> starts = skills::SampleStarts(skill, kExamined, seed + 3000);
  core::Rng rng(seed + 4000);
  for (skills::StartState& start : starts) {
    if (pool.empty() || core::Uniform(rng) >= skill.options.pool_share) continue;
    const auto index = core::UniformIndex(rng, static_cast<std::int64_t>(pool.size()));
    start = skills::PlannedFrom(skill, pool[static_cast<size_t>(index)], rng);
  }
  return starts;
}

Trained TrainSubtask(const TrainRequest& request, const SkillRun& run, const RunSkill& skill,
                     const std::vector<skills::StartState>& pool, bool next_begun,
                     const std::string& place, core::Progress* progress) {
  const fs::path done = skill.folder / kDoneFile;
  bool go_on = request.resume;
  if (fs::exists(done) && fs::exists(skill.folder / rl::kPolicyFile)) {
    const Trained before = ReadTrained(done);
    if (before.learnt || next_begun || !HasBudget(request, before)) return before;
    go_on = true;
  }
  progress->Stage("train " + skill.name + place);
  const RankTraining training = TrainOnAllRanks(request, run, skill, pool, go_on, progress);
  const rl::TrainingResult& result = training.result;
  const rl::PpoOptions ppo = OptionsFor(request, run, skill).ppo;
  Trained trained;
  trained.samples = static_cast<std::int64_t>(result.last.samples);
  trained.seconds = result.last.seconds;
  trained.learnt = result.end == rl::TrainingEnd::kSuccess;
  trained.shares = SharesOf(trained.samples, ppo, run.environments, run.options.action);
  core::Json text = {{"samples", trained.samples},
                     {"seconds", trained.seconds},
                     {"learnt", trained.learnt},
                     {"imitated", trained.shares.imitated},
                     {"critic_alone", trained.shares.critic_alone},
                     {"physics_failures", training.failures}};
  core::WriteFile(done, core::JsonText(text));
  return trained;
}

std::vector<skills::StartState> SuccessfulEnds(const skills::SkillEvaluation& evaluation) {
  std::vector<skills::StartState> ends;
  for (const skills::EvaluatedEpisode& episode : evaluation.episodes) {
    if (episode.success) ends.push_back(episode.end);
  }
  return ends;
}

std::vector<skills::StartState> ReplannedStarts(const skills::Skill& skill,
                                                const std::vector<skills::StartState>& ends,
                                                std::uint64_t seed) {
  std::vector<skills::StartState> starts;
  core::Rng rng(seed);
  for (const skills::StartState& end : ends) starts.push_back(skills::PlannedFrom(skill, end, rng));
  return starts;
}

}  // namespace simwright::workflows
