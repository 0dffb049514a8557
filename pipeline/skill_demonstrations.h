#pragma once

#include <string>
#include <vector>

#include "pipeline/skill_notes.h"
#include "robot/demonstration_file.h"

namespace simwright::pipeline {

// Rollouts as demonstrations for imitation learning, one an episode at the rate of decisions
// (docs/export.md says what each key holds). One in ten, and as many as robomimic's default batch
// takes where half of them are enough, are in the mask "valid", the others in "train". Requires one
// recording.
robot::DemonstrationSet DemonstrationsOf(const SkillRun& run, const std::vector<RunSkill>& skills,
                                         const std::vector<ChainRecording>& recordings,
                                         std::uint64_t seed);

// Steps of a batch of robomimic's defaults: its loader of "valid" gives none of fewer.
constexpr size_t kRobomimicBatch = 100;
// The steps of the demonstrations in "valid".
size_t ValidSteps(const robot::DemonstrationSet& set);

// How one demonstration is repeated: the file's notes have this of each.
struct DemonstrationPlan {
  SkillNotes notes;                 // without times
  std::vector<std::string> starts;  // rl::StartText, by subtask
  std::vector<int> steps;           // decisions, by subtask
};

// Of each demonstration of `set`; also of files that have it in env_kwargs. Throws core::Error, naming `where`, for a file that
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
