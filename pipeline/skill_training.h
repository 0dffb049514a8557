#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "pipeline/skill_run.h"
#include "rl/chain.h"

namespace simwright::pipeline {

struct TrainRequest {
  std::filesystem::path task_file;
  std::vector<std::string> tasks;  // names or patterns (ChooseTasks)
  std::filesystem::path output;
  std::string robot = "panda";
  rl::ActionSpace action = rl::ActionSpace::kFocus;
  double episode_seconds = rl::SkillOptions().episode_seconds;
  // Of the fingers' surfaces, drawn with each episode: from worn plastic to the rubber tips of the
  // Panda's URDF.
  rl::FactorRange finger_friction = {0.8, 2.0};
  int environments = 64;
  std::int64_t samples = 2'000'000;  // of one subtask, at most
  double minutes = 30.0;             // of one subtask, at most; 0: no end
  // Decisions of one subtask at the beginning that imitate a script (rl/scripted_hand.h), where
  // there is one for the action space; 0: PPO alone. Opening microwaves was learnt in 164k
  // decisions and 4 minutes of a core so, and in 1024k and 19 minutes without.
  std::int64_t imitated_samples = 65'536;
  // A subtask is learnt once the lower end of its success rate's 95 % interval is above this.
  double target = 0.92;
  int episodes = 200;  // of each evaluation
  // A subtask whose successor loses more than `largest_handover_loss` of its success by starting
  // where it ends learns on, for so many decisions, to end better; 0: none does.
  double largest_handover_loss = 0.05;
  std::int64_t backward_samples = 120'000;
  std::uint64_t seed = 1;
  bool resume = false;
};

// A subtask that has learnt on to end where its successor can start.
struct BackwardTuning {
  std::int64_t samples = 0;
  double seconds = 0.0;
  double before = 0.0, after = 0.0;  // success of both, one after the other
  bool kept = false;                 // it succeeds more often than before
};

// Which of a training's decisions were not learnt from by PPO: those in which the policy learnt
// what a script does (DAgger), and those from which only the critic learnt, where a guided hand
// followed the script as it is.
struct LearningShares {
  std::int64_t imitated = 0, critic_alone = 0;
};

// What came of one subtask.
struct TrainedSkill {
  std::string name;
  std::filesystem::path folder;
  std::int64_t samples = 0;
  double seconds = 0.0;
  LearningShares shares;
  rl::SkillEvaluation own;               // from its own starts
  rl::SkillEvaluation handover;          // from where the subtask before ended; empty for the first
  std::optional<BackwardTuning> tuning;  // for the subtask after it
  // "imitation of a script", "the script", "PPO", or "imitation of a script (66k decisions), then
  // PPO".
  std::string Method() const;
  // What is lost by starting there: own rate less handover rate.
  double HandoverLoss() const { return own.rate() - handover.rate(); }
};

struct TrainReport {
  std::filesystem::path folder;
  std::vector<TrainedSkill> skills;
  rl::ChainEvaluation chain;  // of the whole task; empty where it has one subtask

  double success() const;  // of the whole
};

// Trains a task's subtasks in order into request.output: each by imitation of a script, where there
// is one, and then by PPO until it is learnt or its time is over, the later ones mostly from where
// the one before ended well, then evaluates them, alone and as a chain. A subtask that has been
// trained before is taken as it is; with `resume` one that was stopped goes on. Throws core::Error
// (ChooseTasks, WriteRun, MakeSkill, TrainPolicy, another process that trains there) and
// core::Cancelled, with all that was trained kept.
TrainReport TrainTask(const TrainRequest& request, core::Progress* progress);

// For a terminal; for machines; and report.json in the run's folder holds the latter.
std::string TrainTable(const TrainReport& report);
std::string TrainJson(const TrainReport& report);

}  // namespace simwright::pipeline
