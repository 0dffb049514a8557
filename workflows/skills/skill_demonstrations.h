#pragma once

#include <string>
#include <vector>

#include "robot/demonstration_file.h"
#include "workflows/skills/skill_metadata.h"

namespace simwright::workflows {

// Converts rollouts into demonstrations for imitation learning, one per episode, at the decision
// rate (docs/export.md describes each key). The mask "valid" contains one in ten, and at least as
// many as robomimic's default batch needs if half of all demonstrations suffice for that; the mask
// "train" contains the others. Requires at least one recording.
robot::DemonstrationSet DemonstrationsOf(const SkillRun& run, const std::vector<RunSkill>& skills,
                                         const std::vector<ChainRecording>& recordings,
                                         std::uint64_t seed);

// The steps of a batch in robomimic's defaults. Its "valid" loader yields no batch from fewer
// steps.
constexpr size_t kRobomimicBatch = 100;
// Returns the number of steps of the demonstrations in "valid".
size_t ValidSteps(const robot::DemonstrationSet& set);

// The replay plan of one demonstration, stored in the file's metadata for each.
struct DemonstrationPlan {
  SkillMetadata metadata;           // without times
  std::vector<std::string> starts;  // skills::StartText, by subtask
  std::vector<int> steps;           // decisions, by subtask
};

// Returns the plan of each demonstration of `set`, including files that store it in env_kwargs.
// Throws core::Error, naming `where`, for a file that DemonstrationsOf did not make.
std::vector<DemonstrationPlan> PlansOf(const robot::DemonstrationSet& set,
                                       const std::string& where);

// Applies the actions of `demonstration` from its start and reports for each subtask, up to the
// first failed one, whether its success held at its end. Each later subtask starts from the state
// that the replay has reached. Throws core::Error, naming `where`, if sizes or starts do not match
// `skills`.
std::vector<bool> ReplayDemonstration(const std::vector<RunSkill>& skills,
                                      const robot::Demonstration& demonstration,
                                      const DemonstrationPlan& plan, const std::string& where);

}  // namespace simwright::workflows
