#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "rl/policy.h"
#include "skills/skill_chain.h"
#include "workflows/skills/skill_matching.h"
#include "workflows/skills/skill_run.h"

namespace simwright::workflows {

struct RolloutRequest {
  std::filesystem::path run;  // a folder written by TrainTask; empty: a shipped policy
  // The shipped policy to run instead (ReadShippedSkill); empty: the run's.
  std::string skill;
  int episodes = 100;
  std::uint64_t seed = 1;
  // Other similar tasks, to evaluate on assets that are not in the training set: a file, and names
  // or patterns in it (ChooseTasks; MatchSkill for a shipped policy). Empty: the run's own, or the
  // evaluation instances of the shipped policy's cell, which are made in a temporary folder.
  std::filesystem::path on;
  std::vector<std::string> tasks;
  // The friction of the fingers' surfaces, the same in all episodes; none: sampled as in training
  // (TrainRequest::finger_friction for a shipped policy).
  std::optional<double> finger_friction;
  // Output files for the first successful episode, else the first one: pictures (PNG) and poses
  // (JSON lines; rollout_pictures.h). Empty: none.
  std::filesystem::path pictures, poses;
};

struct RolloutReport {
  std::vector<std::string> subtasks;
  skills::ChainEvaluation chain;  // one link if the task has one subtask
  double seconds = 0.0;           // mean of the successful episodes
  // For a shipped policy: its name, the subtasks that it acted in, and the tasks of the file that
  // have none for it. Each episode samples one of the subtasks.
  std::string skill;
  std::vector<TakenSubtask> taken;
  std::vector<SkippedTask> skipped;
};

// A run's skills and policies, ready to act. Neither copyable nor movable, because links point into
// it.
class TrainedTask {
 public:
  // `on`: tasks to act in instead of the run's own; `finger_friction`: as in RolloutRequest. Throws
  // core::Error if the folder has no run, its assets have changed, a subtask has no policy (naming
  // it), or `on` does not match.
  explicit TrainedTask(const std::filesystem::path& run,
                       const std::optional<tasks::TaskSet>& on = std::nullopt,
                       std::optional<double> finger_friction = std::nullopt);
  // A shipped policy in the tasks of `run`, which have one subtask each. Throws core::Error if it
  // does not fit them.
  TrainedTask(SkillRun run, rl::Policy policy);
  TrainedTask(const TrainedTask&) = delete;
  TrainedTask& operator=(const TrainedTask&) = delete;

  const SkillRun& run() const { return run_; }
  const std::vector<RunSkill>& skills() const { return skills_; }
  const std::vector<skills::ChainLink>& links() const { return links_; }

 private:
  SkillRun run_;
  std::vector<RunSkill> skills_;
  std::vector<rl::Policy> policies_;
  std::vector<skills::ChainLink> links_;
};

// Runs the whole task from fresh starts sampled with the seed. An episode succeeds if the success
// of every subtask has held for half a second at its end. Throws core::Error as TrainedTask,
// ReadShippedSkill, MatchSkill and MakeCellTasks do.
RolloutReport Rollout(const RolloutRequest& request, core::Progress* progress);

std::string RolloutTable(const RolloutReport& report);
std::string RolloutJson(const RolloutReport& report);

}  // namespace simwright::workflows
