// Compares task decomposition with end-to-end learning: four long tasks
// (workflows/tasks/long_tasks.h), each learned as a chain of subtasks, and undecomposed with as
// many samples, by the reward of the task's goal and by the sum of its subtasks' rewards.
//   bench_long_tasks --task cup_into_microwave --seed 1
//   bench_long_tasks --task cup_into_microwave --method own --samples 200000    without the chain
// An interrupted training resumes; finished results are kept: remove their folder to repeat them.
#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "tasks/task_file.h"
#include "workflows/skills/skill_rollout.h"
#include "workflows/skills/skill_training.h"
#include "workflows/tasks/long_tasks.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

// The episode length (s) of each subtask, at most: after another subtask the arm comes from far,
// around open doors, and takes 5 s to arrive.
constexpr double kSubtaskSeconds = 12.0;
constexpr std::uint64_t kEvaluated = 9000;  // offset of the evaluation seed from the training seed
constexpr int kScriptedChains = 40;  // scripted chains that show which subtasks' success lasts

struct Arguments {
  std::string task = "all", method = "all", action = "delta";
  std::string chain_action = skills::NameOf(workflows::TrainRequest().action);
  double minutes = 15.0;
  bool script = false;
  std::int64_t imitated = workflows::TrainRequest().imitated_samples;
  std::int64_t backward = workflows::TrainRequest().backward_samples;
  std::int64_t samples = 0;
  std::int64_t chain_samples = 1'000'000'000;  // per subtask
  int episodes = 300;
  std::uint64_t seed = 1;
  fs::path output = "out/long_tasks";
};

struct Training {
  std::int64_t samples = 0;
  double seconds = 0.0;
};

void PrintRow(const std::string& name, const std::string& method, const Arguments& arguments,
              const Training& training, int successes, const rl::Interval& interval) {
  std::printf("| %s | %s | %llu | %.0fk | %.1f | %d of %d | %.1f %% (%.1f-%.1f) |\n", name.c_str(),
              method.c_str(), static_cast<unsigned long long>(arguments.seed),
              1e-3 * static_cast<double>(training.samples), training.seconds / 60.0, successes,
              arguments.episodes, 100.0 * successes / arguments.episodes, 100.0 * interval.low,
              100.0 * interval.high);
  std::fflush(stdout);
}

Training SumOf(const workflows::TrainReport& report) {
  Training sum;
  for (const workflows::TrainedSkill& skill : report.skills) {
    sum.samples += skill.samples;
    sum.seconds += skill.seconds;
    if (!skill.tuning) continue;
    sum.samples += skill.tuning->samples;
    sum.seconds += skill.tuning->seconds;
  }
  return sum;
}

// Evaluates the chain again from its own start states.
skills::ChainEvaluation Evaluated(const fs::path& run, const Arguments& arguments) {
  const workflows::TrainedTask trained(run);
  return skills::EvaluateChain(trained.links(), arguments.episodes, arguments.seed + kEvaluated);
}

void PrintHandovers(const workflows::TrainReport& report) {
  for (const workflows::TrainedSkill& skill : report.skills) {
    std::printf("    %-36s own start states %.1f %%", skill.name.c_str(), 100.0 * skill.own.rate());
    if (!skill.handover.episodes.empty()) {
      std::printf(", after the previous %.1f %%, lost %.1f", 100.0 * skill.handover.rate(),
                  100.0 * skill.HandoverLoss());
    }
    std::printf(", %lldk samples\n", static_cast<long long>(skill.samples / 1000));
  }
}

workflows::TrainReport Train(const workflows::LongTask& task, const fs::path& file,
                             const fs::path& run, workflows::TrainRequest request,
                             const Arguments& arguments, core::Progress* progress) {
  request.task_file = file;
  request.tasks = {"*"};
  request.output = run;
  request.robot = task.robot;
  request.seed = arguments.seed;
  request.resume = true;
  return workflows::TrainTask(request, progress);
}

void RunUndecomposed(const workflows::LongTask& task, const tasks::Task& source,
                     const tasks::TaskSet& set, const std::vector<bool>& lasting, bool sum,
                     const fs::path& folder, std::int64_t samples, const Arguments& arguments,
                     core::Progress* progress) {
  const std::string method = sum ? "sum" : "own";
  tasks::SubtaskSelection parts;
  parts.required = lasting;
  parts.rewarded = sum ? std::vector<bool>(lasting.size(), true) : lasting;
  tasks::TaskSet whole = set;
  whole.tasks = {tasks::MergeSubtasks(source, parts, "whole_" + method)};
  const fs::path file = folder / ("tasks_" + method + ".json");
  tasks::WriteTaskFile(whole, file);
  workflows::TrainRequest request;
  request.samples = samples;
  request.minutes = 0.0;
  request.action = skills::ActionSpaceOf(arguments.action);
  request.episode_seconds = kSubtaskSeconds * static_cast<double>(source.subtasks.size());
  const fs::path run = folder / ("run_" + method + "_" + std::to_string(arguments.seed));
  const workflows::TrainReport report = Train(task, file, run, request, arguments, progress);
  const skills::ChainEvaluation found = Evaluated(run, arguments);
  progress->Finish();
  PrintRow(task.name, method, arguments, SumOf(report), found.successes, found.interval);
}

// A task by the scripted expert of its subtasks.
struct ExpertTask {
  workflows::SkillRun run;
  std::vector<workflows::RunSkill> skills;
  skills::ChainEvaluation chain;
};

ExpertTask ByScript(const workflows::LongTask& task, const fs::path& file, int episodes,
                    std::uint64_t seed) {
  ExpertTask scripted;
  scripted.run.robot = task.robot;
  scripted.run.options.episode_seconds = kSubtaskSeconds;
  scripted.run.set = tasks::ReadTaskFile(file);
  scripted.skills = PrepareSkills(scripted.run);
  std::vector<skills::ChainLink> links;
  for (const workflows::RunSkill& skill : scripted.skills) {
    links.push_back({skill.evaluated.get(), nullptr});
  }
  scripted.chain = skills::EvaluateChain(links, episodes, seed);
  return scripted;
}

// Evaluates the scripted expert on the task, and on each subtask.
void EvaluateExpert(const workflows::LongTask& task, const fs::path& file,
                    const Arguments& arguments) {
  const ExpertTask scripted = ByScript(task, file, arguments.episodes, arguments.seed + kEvaluated);
  const skills::ChainEvaluation& chain = scripted.chain;
  PrintRow(task.name, "script", arguments, {}, chain.successes, chain.interval);
  for (size_t k = 0; k < scripted.skills.size(); ++k) {
    const skills::Skill& skill = *scripted.skills[k].evaluated;
    const auto starts =
        skills::SampleStarts(skill, arguments.episodes, arguments.seed + kEvaluated);
    std::printf("    %-36s own start states %d of %d, after the previous %d of %d\n",
                scripted.skills[k].name.c_str(),
                skills::EvaluateScriptedExpert(skill, starts).successes, arguments.episodes,
                chain.succeeded[k], chain.tried[k]);
  }
}

// `lasting`: the subtasks whose success lasts to the end.
void RunWhole(const workflows::LongTask& task, const fs::path& file,
              const std::vector<bool>& lasting, std::int64_t samples, const Arguments& arguments,
              core::Progress* progress) {
  const tasks::TaskSet set = tasks::ReadTaskFile(file);
  for (const bool sum : {false, true}) {
    if (arguments.method != "all" && arguments.method != (sum ? "sum" : "own")) continue;
    RunUndecomposed(task, set.tasks.front(), set, lasting, sum, file.parent_path(), samples,
                    arguments, progress);
  }
}

void RunTask(const workflows::LongTask& task, const Arguments& arguments) {
  core::Progress progress(core::Progress::StyleForStderr());
  const fs::path folder = arguments.output / task.name;
  const fs::path file = workflows::MakeLongTask(task, folder, &progress);
  if (arguments.script) return EvaluateExpert(task, file, arguments);
  if (arguments.samples > 0) {
    const ExpertTask scripted = ByScript(task, file, kScriptedChains, arguments.seed + kEvaluated);
    return RunWhole(task, file, workflows::LastingSubtasks(scripted.skills, scripted.chain),
                    arguments.samples, arguments, &progress);
  }
  workflows::TrainRequest request;
  request.episode_seconds = kSubtaskSeconds;
  request.samples = arguments.chain_samples;
  request.minutes = arguments.minutes;
  request.imitated_samples = arguments.imitated;
  request.backward_samples = arguments.backward;
  request.action = skills::ActionSpaceOf(arguments.chain_action);
  const fs::path run = folder / ("run_chain_" + std::to_string(arguments.seed));
  const workflows::TrainReport report = Train(task, file, run, request, arguments, &progress);
  const skills::ChainEvaluation chain = Evaluated(run, arguments);
  progress.Finish();
  PrintRow(task.name, "chain", arguments, SumOf(report), chain.successes, chain.interval);
  PrintHandovers(report);
  const std::vector<bool> lasting =
      workflows::LastingSubtasks(workflows::TrainedTask(run).skills(), chain);
  RunWhole(task, file, lasting, SumOf(report).samples, arguments, &progress);
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Long tasks: chained subtasks and undecomposed learning");
  simwright::Arguments arguments;
  app.add_option("--task", arguments.task, "One of the long tasks, or all")->capture_default_str();
  app.add_option("--method", arguments.method, "Methods beside the chain: own, sum, all or none")
      ->check(CLI::IsMember({"own", "sum", "all", "none"}))
      ->capture_default_str();
  app.add_option("--action", arguments.action, "Action space of the undecomposed task")
      ->capture_default_str();
  app.add_option("--chain-action", arguments.chain_action, "Action space of the chain")
      ->capture_default_str();
  app.add_option("--minutes", arguments.minutes, "Training time per subtask, at most; 0: unlimited")
      ->capture_default_str();
  app.add_flag("--script", arguments.script, "Only evaluate the scripted expert, without training");
  app.add_option("--imitate", arguments.imitated,
                 "Initial decisions that imitate the scripted expert")
      ->capture_default_str();
  app.add_option("--backward-steps", arguments.backward,
                 "Decisions of fine-tuning a subtask for the next one; 0: no fine-tuning")
      ->capture_default_str();
  app.add_option("--samples", arguments.samples,
                 "Samples of the undecomposed task without a chain; 0: as many as the chain's")
      ->capture_default_str();
  app.add_option("--chain-samples", arguments.chain_samples,
                 "Samples of each subtask of the chain, at most")
      ->capture_default_str();
  app.add_option("--episodes", arguments.episodes, "Episodes per evaluation")
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "Seed of the training")->capture_default_str();
  app.add_option("-o", arguments.output, "Output folder of assets and trainings")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    if (arguments.task != "all") simwright::workflows::LongTaskOf(arguments.task);
    simwright::core::SetThreadCount(0);
    for (const simwright::workflows::LongTask& task : simwright::workflows::LongTasks()) {
      if (arguments.task == "all" || arguments.task == task.name) {
        simwright::RunTask(task, arguments);
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
