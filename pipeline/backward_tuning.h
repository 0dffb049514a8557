#pragma once

#include <optional>
#include <vector>

#include "core/progress.h"
#include "pipeline/skill_run.h"
#include "pipeline/skill_training.h"
#include "rl/skill_evaluation.h"

namespace simwright::pipeline {

// A subtask and the one after it, in a chain.
struct TunedPair {
  const RunSkill* first = nullptr;     // is tuned
  const RunSkill* second = nullptr;    // stays as it is
  std::vector<rl::EpisodeStart> pool;  // where `first` begins in the chain; empty: its own
  std::vector<rl::EvaluatedEpisode> second_tried;  // from where `first` has ended
};

// What came of it, or what came of it before; none where it has not been tried.
std::optional<BackwardTuning> ReadBackwardTuning(const RunSkill& first);

// Goes on training `first` with what its successes are worth to `second` (rl/successor.h): of the
// ends that count as success it learns to prefer those from which the chain goes on. Its policy is
// replaced where that makes both together succeed more often from fresh starts, the old one is kept
// as policy_before.pt. Into first.folder/backward; goes on where it was stopped; what has been
// tried is not tried again. Throws core::Error and core::Cancelled as TrainTask.
BackwardTuning TuneBackward(const TrainRequest& request, const SkillRun& run, const TunedPair& pair,
                            core::Progress* progress);

}  // namespace simwright::pipeline
