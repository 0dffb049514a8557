// Counts the planted faults that verification finds, and the correct programs that it flags: the
// table of docs/rewards.md.
//   bench_mutation_table ASSET... [--count N]
// on the programs of the tasks that the rules generate for the assets (folders, or folders of
// them).
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "tasks/rules/rule_tasks.h"
#include "tasks/verification/subtask_verifier.h"
#include "tests/reward/reward_mutations.h"
#include "workflows/tasks/task_assets.h"

namespace simwright {
namespace {

struct Count {
  int all = 0, errors = 0, warnings = 0;
};

using Counts = std::map<std::string, Count>;

// Returns the program that moves the same joint in the opposite direction.
std::string OppositeProgram(const std::vector<tasks::Task>& made, const std::string& name) {
  for (const auto& [from, to] : {std::pair{"open_", "close_"},
                                 {"close_", "open_"},
                                 {"turn_on_", "turn_off_"},
                                 {"turn_off_", "turn_on_"}}) {
    if (name.rfind(from, 0) != 0) continue;
    const std::string wanted = to + name.substr(std::string(from).size());
    for (const tasks::Task& task : made) {
      if (task.name == wanted) return task.subtasks[0].program;
    }
  }
  return "";
}

void Tally(const tasks::WorldModel& model, const tasks::Task& task,
           const std::vector<reward::Mutant>& mutants, Counts* counts) {
  for (const reward::Mutant& mutant : mutants) {
    tasks::SubtaskVerifier verifier(model);
    tasks::Subtask subtask = mutant.subtask;
    const core::Findings findings = verifier.Verify(task, &subtask);
    const bool error = std::any_of(
        findings.begin(), findings.end(),
        [](const core::Finding& finding) { return finding.severity == core::Severity::kError; });
    Count& count = (*counts)[mutant.kind];
    ++count.all;
    count.errors += error;
    count.warnings += !error && !findings.empty();
  }
}

void Print(const char* title, const std::vector<Counts>& parts) {
  Counts counts;
  Count total;
  for (const Counts& part : parts) {
    for (const auto& [kind, count] : part) {
      for (Count* into : {&counts[kind], &total}) {
        into->all += count.all;
        into->errors += count.errors;
        into->warnings += count.warnings;
      }
    }
  }
  counts["all"] = total;
  std::printf("| %s | programs | error | warning | neither |\n|---|---|---|---|---|\n", title);
  for (const auto& [kind, count] : counts) {
    std::printf("| %s | %d | %.1f %% | %.1f %% | %d |\n", kind.c_str(), count.all,
                100.0 * count.errors / count.all, 100.0 * count.warnings / count.all,
                count.all - count.errors - count.warnings);
  }
}

int Run(const std::vector<std::string>& arguments, int count) {
  const workflows::TaskAssets assets = workflows::ReadTaskAssets(arguments);
  const tasks::WorldModel model = tasks::MakeWorldModel(assets.models);
  const tasks::RuleTasks made = tasks::GenerateTasksByRules(model, {count, 1});
  const int tasks = static_cast<int>(made.tasks.size());
  std::vector<Counts> faults(made.tasks.size()), rewrites(made.tasks.size());
  core::ParallelFor(tasks, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const tasks::Task& task = made.tasks[at];
    for (const tasks::Subtask& subtask : task.subtasks) {
      const std::string other = OppositeProgram(made.tasks, subtask.name);
      Tally(model, task, reward::PlantFaults(subtask, other), &faults[at]);
      Tally(model, task, reward::RewriteSoundly(subtask), &rewrites[at]);
    }
  });
  std::printf("%d tasks on %zu assets\n\n", tasks, model.objects.size());
  Print("fault", faults);
  std::printf("\n");
  Print("correct rewriting", rewrites);
  std::printf("\ninfeasible task candidates of the rules:");
  for (const auto& [why, times] : made.dropped) std::printf(" %s %d", why.c_str(), times);
  std::printf("\n");
  return 0;
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  std::vector<std::string> assets;
  int count = 0;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--count" && i + 1 < argc) {
      count = std::atoi(argv[++i]);
    } else {
      assets.emplace_back(argv[i]);
    }
  }
  try {
    return simwright::Run(assets, count);
  } catch (const simwright::core::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
