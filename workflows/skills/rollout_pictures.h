#pragma once

#include <string>

#include "core/image.h"
#include "workflows/skills/skill_recording.h"
#include "workflows/skills/skill_run.h"

namespace simwright::workflows {

// Renders an episode as pictures: twelve moments of each subtask, evenly spaced from start to end,
// six per row, from one camera behind and to the right of the robot. RGBA.
core::Image RolloutStrip(const std::vector<RunSkill>& skills, const ChainRecording& recording);

// Writes the episode as JSON lines, one per control step: joints of the robot, poses and joints of
// the objects (docs/formats.md).
std::string RolloutPoses(const SkillRun& run, const std::vector<RunSkill>& skills,
                         const ChainRecording& recording);

}  // namespace simwright::workflows
