#include "pipeline/skill_training.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "rl/policy_file.h"
#include "rl/skill_environment.h"
#include "rl/start_pool.h"
#include "rl/training.h"
#include "tasks/task_file.h"

namespace simwright::pipeline {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

constexpr const char* kEndsFile = "ends.jsonl";  // where episodes ended well
constexpr const char* kDoneFile = "trained.json";
// Episodes of an examination: four seconds on two cores. 124 successes of them give an interval
// that begins above 0.92, the default target.
constexpr int kExamined = 128;

// Options of PPO that fit skills at 20 Hz with 64 environments. The smaller deviation: zero is
// already where the hand works, and what is drawn knocks things over.
rl::TrainingOptions OptionsFor(const TrainRequest& request, const SkillRun& run,
                               const RunSkill& skill) {
  rl::TrainingOptions options;
  options.ppo.discount = run.options.discount;
  // Opening drawers that it had not seen, a policy succeeded in 88 % of the episodes after 233k
  // decisions; with a horizon of 32 and minibatches of 512 in 59 % (discount 0.97). With 128 and
  // 2048, discount 0.97, a microwave's door was opened in 55 % after 205k; with these and a
  // discount of 0.98 in 95 % after 209k.
  options.ppo.horizon = 64;
  options.ppo.epochs = 5;
  options.ppo.minibatch = 1024;
  options.ppo.target_kl = 0.02;
  options.ppo.initial_std = 0.35;
  options.ppo.seed = request.seed;
  options.max_samples = request.samples;
  options.max_seconds = 60.0 * request.minutes;
  options.success_target = request.target;
  options.facts = {
      {"task", run.set.tasks.front().name}, {"subtask", skill.name}, {"robot", run.robot}};
  options.title = skill.name;
  return options;
}

struct Trained {
  std::int64_t samples = 0;
  double seconds = 0.0;
  bool learnt = false;  // the target was reached, not only the time or samples used up
};

Trained ReadTrained(const fs::path& file) {
  try {
    const json text = json::parse(core::ReadFile(file, 1 << 20));
    return {text.at("samples").get<std::int64_t>(), text.at("seconds").get<double>(),
            text.at("learnt").get<bool>()};
  } catch (const json::exception&) {
    throw core::Error("is damaged", file.string(), "remove it: the training then goes on");
  }
}

// One failure may happen to anybody; more than one in 100,000 decisions is a broken scene.
void RequireSoundPhysics(const rl::SkillEnvironment& environment, const std::string& subtask,
                         double samples) {
  const std::int64_t failures = environment.failures();
  if (failures <= 1 || static_cast<double>(failures) <= 1e-5 * samples) return;
  throw core::Error("the physics failed in " + std::to_string(failures) + " of " +
                        std::to_string(static_cast<std::int64_t>(samples)) +
                        " decisions, the last in " + environment.LastFailure(),
                    "subtask " + subtask, "check its assets with `simwright check`");
}

// A subtask that has used up what it was given goes on where it is given more.
bool HasBudget(const TrainRequest& request, const Trained& before) {
  return before.samples < request.samples &&
         (request.minutes == 0.0 || before.seconds < 60.0 * request.minutes);
}

// What a policy is examined from while it learns: as its episodes begin, but none of them easier.
// Other starts than those of the evaluation that is reported.
std::vector<rl::EpisodeStart> ExaminedStarts(const rl::Skill& skill,
                                             const std::vector<rl::EpisodeStart>& pool,
                                             std::uint64_t seed) {
  std::vector<rl::EpisodeStart> starts = rl::DrawStarts(skill, kExamined, seed + 3000);
  core::Rng rng(seed + 4000);
  for (rl::EpisodeStart& start : starts) {
    if (pool.empty() || core::Uniform(rng) >= skill.options.pool_share) continue;
    const auto index = core::UniformIndex(rng, static_cast<std::int64_t>(pool.size()));
    start = rl::Varied(skill, pool[static_cast<size_t>(index)], rng);
  }
  return starts;
}

Trained TrainOne(const TrainRequest& request, const SkillRun& run, const RunSkill& skill,
                 const std::vector<rl::EpisodeStart>& pool, bool successor_begun,
                 core::Progress* progress) {
  const fs::path done = skill.folder / kDoneFile;
  bool go_on = request.resume;
  if (fs::exists(done) && fs::exists(skill.folder / rl::kPolicyFile)) {
    const Trained before = ReadTrained(done);
    if (before.learnt || successor_begun || !HasBudget(request, before)) return before;
    go_on = true;
  }
  rl::SkillEnvironment environment(skill.skill, run.environments, pool);
  const std::vector<rl::EpisodeStart> starts = ExaminedStarts(*skill.evaluated, pool, request.seed);
  const rl::TrainingOptions options = OptionsFor(request, run, skill);
  const int iterations =
      static_cast<int>(request.samples / (options.ppo.horizon * run.environments));
  progress->Stage("train " + skill.name, iterations);
  const rl::TrainingResult result = rl::TrainPolicy(
      &environment, options, skill.folder, go_on,
      [&](const rl::TrainingRecord& record) {
        RequireSoundPhysics(environment, skill.name, record.samples);
        progress->Advance();
      },
      [&](const rl::Policy& policy) {
        const rl::SkillEvaluation found = rl::Evaluate(*skill.evaluated, policy, starts);
        return rl::Examination{found.successes, kExamined};
      });
  const Trained trained{static_cast<std::int64_t>(result.last.samples), result.last.seconds,
                        result.end == rl::TrainingEnd::kSuccess};
  json text = {{"samples", trained.samples},
               {"seconds", trained.seconds},
               {"learnt", trained.learnt},
               {"physics_failures", environment.failures()}};
  core::WriteFile(done, text.dump(2) + "\n");
  return trained;
}

std::vector<rl::EpisodeStart> GoodEnds(const rl::SkillEvaluation& evaluation) {
  std::vector<rl::EpisodeStart> ends;
  for (const rl::EvaluatedEpisode& episode : evaluation.episodes) {
    if (episode.success) ends.push_back(episode.end);
  }
  return ends;
}

// Where the next subtask begins: the ends of episodes that began as this one does in the chain.
std::vector<rl::EpisodeStart> Replanned(const rl::Skill& skill,
                                        const std::vector<rl::EpisodeStart>& ends,
                                        std::uint64_t seed) {
  std::vector<rl::EpisodeStart> starts;
  core::Rng rng(seed);
  for (const rl::EpisodeStart& end : ends) starts.push_back(rl::Varied(skill, end, rng));
  return starts;
}

json IntervalJson(const rl::SkillEvaluation& evaluation) {
  return {{"episodes", evaluation.episodes.size()},
          {"successes", evaluation.successes},
          {"rate", evaluation.rate()},
          {"low", evaluation.interval.low},
          {"high", evaluation.interval.high},
          {"mean_seconds", evaluation.seconds}};
}

std::string Percent(const rl::SkillEvaluation& evaluation) {
  if (evaluation.episodes.empty()) return "-";
  char text[64];
  std::snprintf(text, sizeof(text), "%.0f %% (%.0f-%.0f)", 100.0 * evaluation.rate(),
                100.0 * evaluation.interval.low, 100.0 * evaluation.interval.high);
  return text;
}

}  // namespace

double TrainReport::success() const {
  if (chain.outcomes.empty()) return skills.empty() ? 0.0 : skills.front().own.rate();
  return static_cast<double>(chain.successes) / static_cast<double>(chain.outcomes.size());
}

TrainReport TrainTask(const TrainRequest& request, core::Progress* progress) {
  SkillRun run;
  run.folder = request.output;
  run.set = ChooseTasks(tasks::ReadTaskFile(request.task_file), request.tasks,
                        request.task_file.string());
  run.robot = request.robot;
  run.options.action = request.action;
  run.options.episode_seconds = request.episode_seconds;
  run.options.evaluation_seconds = request.evaluation_seconds;
  run.environments = request.environments;
  run.seed = request.seed;
  if (fs::exists(run.folder) && !request.resume) {
    throw core::Error("is there already", run.folder.string(),
                      "go on with --resume, or give another folder");
  }
  const std::vector<RunSkill> skills = PrepareSkills(run);
  WriteRun(run);
  TrainReport report;
  report.folder = run.folder;
  std::vector<rl::EpisodeStart> ends;
  std::vector<rl::Policy> policies;
  std::vector<rl::ChainLink> links;
  policies.reserve(skills.size());
  for (const RunSkill& skill : skills) {
    // A successor that has begun to learn began where this one's episodes ended.
    const auto next = static_cast<size_t>(&skill - skills.data()) + 1;
    const bool successor_begun =
        next < skills.size() && fs::exists(skills[next].folder / rl::kCheckpointFile);
    TrainedSkill trained;
    trained.name = skill.name;
    trained.folder = skill.folder;
    const Trained numbers = TrainOne(request, run, skill, ends, successor_begun, progress);
    trained.samples = numbers.samples;
    trained.seconds = numbers.seconds;
    policies.push_back(rl::ReadPolicy(skill.folder / rl::kPolicyFile));
    progress->Stage("evaluate " + skill.name);
    const auto starts = rl::DrawStarts(*skill.evaluated, request.episodes, request.seed + 1000);
    trained.own = rl::Evaluate(*skill.evaluated, policies.back(), starts);
    if (!ends.empty()) {
      trained.handover = rl::Evaluate(*skill.evaluated, policies.back(),
                                      Replanned(*skill.evaluated, ends, request.seed));
    }
    ends = GoodEnds(ends.empty() ? trained.own : trained.handover);
    rl::WriteStarts(ends, skill.folder / kEndsFile);
    links.push_back({skill.evaluated.get(), &policies.back()});
    report.skills.push_back(std::move(trained));
    if (ends.empty() && links.size() < skills.size()) {
      throw core::Error("was not learnt: the subtasks after it have nowhere to start",
                        "subtask " + skill.name, "give it more --minutes, and --resume");
    }
  }
  if (skills.size() > 1) {
    progress->Stage("evaluate the whole task");
    report.chain = rl::EvaluateChain(links, request.episodes, request.seed + 2000);
  }
  core::WriteFile(run.folder / "report.json", TrainJson(report));
  return report;
}

std::string TrainTable(const TrainReport& report) {
  std::string table =
      "subtask                            samples  minutes  own starts       after the one "
      "before\n";
  for (const TrainedSkill& skill : report.skills) {
    char line[256];
    std::snprintf(line, sizeof(line), "%-34.34s %8lld %8.1f  %-16s %s\n", skill.name.c_str(),
                  static_cast<long long>(skill.samples), skill.seconds / 60.0,
                  Percent(skill.own).c_str(), Percent(skill.handover).c_str());
    table += line;
  }
  if (!report.chain.outcomes.empty()) {
    char line[128];
    std::snprintf(line, sizeof(line), "whole task: %d of %zu, %.0f %% (%.0f-%.0f)\n",
                  report.chain.successes, report.chain.outcomes.size(), 100.0 * report.success(),
                  100.0 * report.chain.interval.low, 100.0 * report.chain.interval.high);
    table += line;
  }
  return table;
}

std::string TrainJson(const TrainReport& report) {
  json text;
  text["folder"] = report.folder.string();
  text["success"] = report.success();
  for (const TrainedSkill& skill : report.skills) {
    json one = {{"name", skill.name},
                {"samples", skill.samples},
                {"seconds", skill.seconds},
                {"own_starts", IntervalJson(skill.own)}};
    if (!skill.handover.episodes.empty()) {
      one["after_the_one_before"] = IntervalJson(skill.handover);
      one["handover_loss"] = skill.HandoverLoss();
    }
    text["subtasks"].push_back(one);
  }
  if (!report.chain.outcomes.empty()) {
    text["chain"] = {{"episodes", report.chain.outcomes.size()},
                     {"successes", report.chain.successes},
                     {"low", report.chain.interval.low},
                     {"high", report.chain.interval.high},
                     {"tried", report.chain.tried},
                     {"succeeded", report.chain.succeeded}};
  }
  return text.dump(2) + "\n";
}

}  // namespace simwright::pipeline
