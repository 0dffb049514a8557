#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "rl/training_options.h"
#include "rl/training_record.h"
#include "skills/skill_environment.h"
#include "workflows/skills/skill_run.h"
#include "workflows/skills/skill_training.h"

namespace simwright::workflows {

struct Trained {
  std::int64_t samples = 0;
  double seconds = 0.0;
  bool learnt = false;  // the target was reached, not just the time or sample bound
  LearningShares shares;
};

// Returns how the first `samples` decisions, in batches of options.horizon x environments, were
// used for learning.
LearningShares SharesOf(std::int64_t samples, const rl::PpoOptions& options, int environments,
                        skills::ActionSpace action);

// Returns PPO options for skills at 20 Hz with 64 environments. The initial standard deviation is
// small, because a zero action already moves to the interaction target and random actions knock
// objects over.
rl::TrainingOptions OptionsFor(const TrainRequest& request, const SkillRun& run,
                               const RunSkill& skill);

// Returns an upper bound on the remaining training time, s, from its samples and seconds.
double TimeLeft(const rl::TrainingRecord& record, const rl::TrainingOptions& options);
// Reports decisions, success rate and the remaining time beside the stage's name.
void ReportProgress(const rl::TrainingRecord& record, const rl::TrainingOptions& options,
                    core::Progress* progress);

// Throws core::Error, with how to reproduce it, if the physics failed in more than one of 100,000
// decisions (`samples` so far), which indicates a broken scene. A single failure is tolerated.
void RequireValidPhysics(const skills::SkillEnvironment& environment, const std::string& subtask,
                         double samples);

// Returns the starts from which a policy is examined during training: those of its episodes,
// without easier ones. They differ from the starts of the reported evaluation.
std::vector<skills::StartState> ExaminationStarts(const skills::Skill& skill,
                                                  const std::vector<skills::StartState>& pool,
                                                  std::uint64_t seed);

// Trains one subtask into its folder, by imitation and PPO as `request` says, with a fraction of
// its episodes starting in `pool`, unless it has been learnt before or its successor has begun to
// learn from its policy. `place`: text after its name in progress messages, ", subtask 2 of 4".
// Throws core::Error and core::Cancelled as TrainTask does.
Trained TrainSubtask(const TrainRequest& request, const SkillRun& run, const RunSkill& skill,
                     const std::vector<skills::StartState>& pool, bool next_begun,
                     const std::string& place, core::Progress* progress);

// Returns the end states of the successful episodes.
std::vector<skills::StartState> SuccessfulEnds(const skills::SkillEvaluation& evaluation);

// Returns starts of `skill` at `ends`, planned from there and randomised as in the chain.
std::vector<skills::StartState> ReplannedStarts(const skills::Skill& skill,
                                                const std::vector<skills::StartState>& ends,
                                                std::uint64_t seed);

}  // namespace simwright::workflows
