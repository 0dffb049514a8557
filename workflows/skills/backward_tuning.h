#pragma once

#include <optional>
#include <vector>

#include "core/progress.h"
#include "skills/skill_evaluation.h"
#include "workflows/skills/skill_run.h"
#include "workflows/skills/skill_training.h"

namespace simwright::workflows {

// Two consecutive subtasks of a chain.
struct TunedPair {
  const RunSkill* first = nullptr;       // the skill to tune
  const RunSkill* second = nullptr;      // unchanged
  std::vector<skills::StartState> pool;  // starts of `first` in the chain; empty: its own starts
  std::vector<skills::EvaluatedEpisode>
      second_tried;  // episodes of `second` from the ends of `first`
};

// Returns the recorded outcome of tuning `first`, or nothing if tuning has not been tried.
std::optional<BackwardTuning> ReadBackwardTuning(const RunSkill& first);

// Continues training `first` with a terminal reward: the value of its end states to `second`
// (rl/successor.h). Among successful ends, the policy learns to prefer those from which the chain
// succeeds. The policy is replaced if both skills together then succeed more often from fresh
// starts; the previous policy is kept as policy_before.pt. Works in first.folder/backward, resumes
// an interrupted training, and does not repeat a finished one. Throws core::Error and
// core::Cancelled as TrainTask does.
BackwardTuning TuneBackward(const TrainRequest& request, const SkillRun& run, const TunedPair& pair,
                            core::Progress* progress);

}  // namespace simwright::workflows
