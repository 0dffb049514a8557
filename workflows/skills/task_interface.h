#pragma once

#include <optional>
#include <string>

#include "skills/episode_start.h"
#include "workflows/skills/skill_run.h"
#include "workflows/skills/task_world.h"

namespace simwright::workflows {

// Returns the start that the subtask describes, planned: objects in place, the robot at home. With
// `seed`: a start sampled as in an evaluation (skills::SampleStart).
skills::StartState TaskStart(const skills::Skill& skill, std::optional<std::uint64_t> seed);

// Returns what a controller outside of Simwright needs to observe and act in the world of a task,
// as JSON (docs/formats.md): names of bodies and joints in `world`'s MJCF, the target frame, the
// limits of the robot, the layout of the observation and the constants of the action space. The
// constants are those of ActionSpace::kTargetFrame; for others the file has the layout alone.
std::string TaskInterfaceJson(const RunSkill& skill, const TaskWorld& world,
                              const skills::StartState& start);

}  // namespace simwright::workflows
