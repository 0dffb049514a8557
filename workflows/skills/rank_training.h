#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/progress.h"
#include "rl/training.h"
#include "rl/training_options.h"
#include "skills/episode_start.h"
#include "workflows/skills/skill_run.h"
#include "workflows/skills/skill_training.h"

namespace simwright::workflows {

// The outcome of a subtask's training by all ranks.
struct RankTraining {
  rl::TrainingResult result;
  std::int64_t failures = 0;  // decisions with failed physics, of all ranks
};

// Trains a subtask in its folder on all ranks of `request`, of which this is rank 0: each runs its
// share of run.environments. `pool`: states in which a share of the episodes start; `resume`: from
// the folder's checkpoint, if there is one. Throws core::Error and core::Cancelled as TrainTask
// does.
RankTraining TrainOnAllRanks(const TrainRequest& request, const SkillRun& run,
                             const RunSkill& skill, const std::vector<skills::StartState>& pool,
                             bool resume, core::Progress* progress);

// Tells the other ranks that there is nothing more to train.
void DismissRanks(const TrainRequest& request);

// The part of the other ranks: they train what rank 0 asks for until it dismisses them. `skills`
// are the prepared ones of `run`.
void FollowRankZero(const TrainRequest& request, const SkillRun& run,
                    const std::vector<RunSkill>& skills);

}  // namespace simwright::workflows
