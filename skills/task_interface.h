#pragma once

#include <optional>
#include <string>

#include "skills/episode_start.h"
#include "skills/task_world.h"

namespace simwright::skills {

// Returns the start that the subtask describes, planned: objects in place, the robot at home. With
// `seed`: a start sampled as in an evaluation (SampleStart).
StartState TaskStart(const Skill& skill, std::optional<std::uint64_t> seed);

// Returns what a controller of the subtask `name` outside of Simwright needs to observe and act in
// the world of a task, as JSON (docs/formats.md): names of bodies and joints in `world`'s MJCF, the
// target frame, the limits of the robot, the layout of the observation and the constants of the
// action space. The constants are those of ActionSpace::kTargetFrame; for others the file has the
// layout alone.
std::string TaskInterfaceJson(const std::string& name, const Skill& skill, const TaskWorld& world,
                              const StartState& start);

}  // namespace simwright::skills
