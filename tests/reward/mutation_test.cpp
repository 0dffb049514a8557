// Faults planted in valid programs are found, and programs that differ only in form pass.
#include <gtest/gtest.h>

#include <map>

#include "tasks/rules/rule_tasks.h"
#include "tasks/verification/subtask_verifier.h"
#include "tests/reward/reward_mutations.h"
#include "tests/tasks/household.h"

namespace simwright::reward {
namespace {

struct Count {
  int all = 0, found = 0;
};

// Returns the program of the task that moves the same joint in the opposite direction.
std::string OtherWay(const tasks::RuleTasks& tasks, const std::string& name) {
  const auto swapped = [&](const std::string& from, const std::string& to) {
    return name.rfind(from, 0) == 0 ? to + name.substr(from.size()) : std::string();
  };
  for (const std::string& wanted : {swapped("open_", "close_"), swapped("close_", "open_")}) {
    for (const tasks::Task& task : tasks.tasks) {
      if (!wanted.empty() && task.name == wanted) return task.subtasks[0].program;
    }
  }
  return "";
}

class Mutation : public testing::Test {
 protected:
  Mutation()
      : model_(tasks::MakeWorldModel({tasks::Microwave(), tasks::DrawerUnit(), tasks::Cup(),
                                      tasks::Cup("jug", 0.045, 0.16),
                                      tasks::Box("book", {0.2, 0.15, 0.03}, 0.6),
                                      tasks::Box("tin", {0.06, 0.06, 0.08}, 0.3)})),
        tasks_(tasks::GenerateTasksByRules(model_, {60, 1})) {}

  core::Findings Verify(const tasks::Task& task, tasks::Subtask subtask) {
    tasks::SubtaskVerifier verifier(model_);
    return verifier.Verify(task, &subtask);
  }

  tasks::WorldModel model_;
  tasks::RuleTasks tasks_;
};

TEST_F(Mutation, FaultsAreFound) {
  std::map<std::string, Count> counts;
  Count total;
  for (const tasks::Task& task : tasks_.tasks) {
    for (const tasks::Subtask& subtask : task.subtasks) {
      for (const Mutant& mutant : PlantFaults(subtask, OtherWay(tasks_, subtask.name))) {
        const core::Findings findings = Verify(task, mutant.subtask);
        const bool found = !findings.empty();
        Count& count = counts[mutant.kind];
        ++count.all;
        ++total.all;
        count.found += found;
        total.found += found;
        if (!found) {
          std::printf("missed: %s in %s\n%s", mutant.kind.c_str(), subtask.name.c_str(),
                      mutant.subtask.program.c_str());
        }
      }
    }
  }
  EXPECT_GT(total.all, 1000);
  for (const auto& [kind, count] : counts) {
    EXPECT_GE(count.found, 0.95 * count.all) << kind << ": " << count.found << " of " << count.all;
  }
  RecordProperty("found", total.found);
}

TEST_F(Mutation, SoundProgramsPass) {
  Count total;
  for (const tasks::Task& task : tasks_.tasks) {
    for (const tasks::Subtask& subtask : task.subtasks) {
      for (const Mutant& mutant : RewriteSoundly(subtask)) {
        const core::Findings findings = Verify(task, mutant.subtask);
        ++total.all;
        total.found += !findings.empty();
        if (!findings.empty()) {
          std::printf("flagged: %s in %s: %s\n", mutant.kind.c_str(), subtask.name.c_str(),
                      findings[0].sentence.c_str());
        }
      }
    }
  }
  EXPECT_GT(total.all, 800);
  EXPECT_LE(total.found, 0.01 * total.all) << total.found << " of " << total.all;
}

// Candidates of the rules that the verification rejected: none may be rejected for a sign.
TEST_F(Mutation, TheRulesOwnProgramsAreNotRefused) {
  for (const auto& [why, count] : tasks_.dropped) {
    EXPECT_TRUE(why == "no-layout" || why == "no-plan" || why == "same-name")
        << why << " " << count;
  }
}

}  // namespace
}  // namespace simwright::reward
