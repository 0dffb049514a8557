#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "pipeline/skill_run.h"
#include "pipeline/skill_training.h"
#include "rl/skill_environment.h"
#include "rl/training_options.h"
#include "rl/training_record.h"

namespace simwright::pipeline {

struct Trained {
  std::int64_t samples = 0;
  double seconds = 0.0;
  bool learnt = false;  // the target was reached, not only the time or samples used up
  LearningShares shares;
};

// What `samples` decisions in batches of options.horizon x environments were learnt from.
LearningShares SharesOf(std::int64_t samples, const rl::PpoOptions& options, int environments,
                        rl::ActionSpace action);

// Options of PPO that fit skills at 20 Hz with 64 environments. The smaller deviation: zero is
// already where the hand works, and what is drawn knocks things over.
rl::TrainingOptions OptionsFor(const TrainRequest& request, const SkillRun& run,
                               const RunSkill& skill);

// s that a training is still at work at most, as its samples and seconds bound it.
double TimeLeft(const rl::TrainingRecord& record, const rl::TrainingOptions& options);
// Decisions, success and the time left, beside the stage's name.
void SayHowFar(const rl::TrainingRecord& record, const rl::TrainingOptions& options,
               core::Progress* progress);

// Throws core::Error, with what repeats it, where the physics failed in more than one of 100,000
// decisions (`samples` so far): that is a broken scene. One failure may happen to anybody.
void RequireSoundPhysics(const rl::SkillEnvironment& environment, const std::string& subtask,
                         double samples);

// What a policy is examined from while it learns: as its episodes begin, but none of them easier.
// Other starts than those of the evaluation that is reported.
std::vector<rl::EpisodeStart> ExaminedStarts(const rl::Skill& skill,
                                             const std::vector<rl::EpisodeStart>& pool,
                                             std::uint64_t seed);

// Trains one subtask into its folder, by imitation and PPO as `request` says, a share of its
// episodes beginning in `pool`, unless it has been learnt before, or its successor has begun to
// learn from what it was. `place`: what progress says beside its name, ", subtask 2 of 4". Throws
// core::Error and core::Cancelled, as TrainTask.
Trained TrainOne(const TrainRequest& request, const SkillRun& run, const RunSkill& skill,
                 const std::vector<rl::EpisodeStart>& pool, bool successor_begun,
                 const std::string& place, core::Progress* progress);

// Where the episodes that succeeded have ended.
std::vector<rl::EpisodeStart> GoodEnds(const rl::SkillEvaluation& evaluation);

// Where the next subtask begins: the ends of episodes that began as this one does in the chain.
std::vector<rl::EpisodeStart> Replanned(const rl::Skill& skill,
                                        const std::vector<rl::EpisodeStart>& ends,
                                        std::uint64_t seed);

}  // namespace simwright::pipeline
