#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "pipeline/skill_run.h"
#include "rl/chain.h"
#include "rl/policy.h"

namespace simwright::pipeline {

struct RolloutRequest {
  std::filesystem::path run;  // a folder that TrainTask wrote
  int episodes = 100;
  std::uint64_t seed = 1;
  // Other tasks alike, to see what was learnt on assets that the training has not seen: a file and
  // names or patterns in it (ChooseTasks). Empty: the run's own.
  std::filesystem::path on;
  std::vector<std::string> tasks;
  // Of the fingers' surfaces, the same in all episodes; none: drawn as in the training.
  std::optional<double> finger_friction;
  // Of the first episode that succeeds, else of the first: pictures (PNG) and poses (JSON lines;
  // rollout_pictures.h). Empty: none.
  std::filesystem::path pictures, poses;
};

struct RolloutReport {
  std::vector<std::string> subtasks;
  rl::ChainEvaluation chain;  // of one link where the task has one subtask
  double seconds = 0.0;       // mean of those that succeeded
};

// A run's skills and policies, ready to act. Not copied or moved: links point into it.
class TrainedTask {
 public:
  // `on`: other tasks to act in than the run's own; `finger_friction`: as RolloutRequest's. Throws
  // core::Error where the folder holds no run, its assets have changed, a subtask has no policy,
  // naming it, or `on` does not fit.
  explicit TrainedTask(const std::filesystem::path& run,
                       const std::optional<tasks::TaskSet>& on = std::nullopt,
                       std::optional<double> finger_friction = std::nullopt);
  TrainedTask(const TrainedTask&) = delete;
  TrainedTask& operator=(const TrainedTask&) = delete;

  const SkillRun& run() const { return run_; }
  const std::vector<RunSkill>& skills() const { return skills_; }
  const std::vector<rl::ChainLink>& links() const { return links_; }

 private:
  SkillRun run_;
  std::vector<RunSkill> skills_;
  std::vector<rl::Policy> policies_;
  std::vector<rl::ChainLink> links_;
};

// Runs the whole task from starts of its own, drawn by the seed. Success: every subtask's has held
// for half a second at its end.
RolloutReport Rollout(const RolloutRequest& request, core::Progress* progress);

std::string RolloutTable(const RolloutReport& report);
std::string RolloutJson(const RolloutReport& report);

}  // namespace simwright::pipeline
