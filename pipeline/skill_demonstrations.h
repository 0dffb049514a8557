#pragma once

#include <string>
#include <vector>

#include "pipeline/skill_notes.h"
#include "robot/demonstration_file.h"

namespace simwright::pipeline {

// Rollouts as demonstrations for imitation learning, one an episode at the rate of decisions
// (docs/export.md says what each key holds). One in ten, at least one of two, is in the mask
// "valid", the others in "train". Requires one recording.
robot::DemonstrationSet DemonstrationsOf(const SkillRun& run, const std::vector<RunSkill>& skills,
                                         const std::vector<ChainRecording>& recordings,
                                         std::uint64_t seed);

// How one demonstration is repeated: env_kwargs has this of each.
struct DemonstrationPlan {
  SkillNotes notes;                 // without times
  std::vector<std::string> starts;  // rl::StartText, by subtask
  std::vector<int> steps;           // decisions, by subtask
};

// Of each demonstration of `set`. Throws core::Error, naming `where`, for a file that
// DemonstrationsOf did not make.
std::vector<DemonstrationPlan> PlansOf(const robot::DemonstrationSet& set,
                                       const std::string& where);

// Lets the actions of `demonstration` act from its start, and says of each subtask, up to the first
// that failed, whether its success had held at its end. Later subtasks begin where the replay has
// come to. Throws core::Error, naming `where`, where sizes or starts do not fit `skills`.
std::vector<bool> ReplayDemonstration(const std::vector<RunSkill>& skills,
                                      const robot::Demonstration& demonstration,
                                      const DemonstrationPlan& plan, const std::string& where);

}  // namespace simwright::pipeline
