#pragma once

#include <string>

#include "core/image.h"
#include "pipeline/skill_recording.h"
#include "pipeline/skill_run.h"

namespace simwright::pipeline {

// An episode in pictures: of each subtask twelve moments, evenly over its time from start to end,
// six a row, seen by one camera from behind the robot's right. RGBA.
core::Image RolloutStrip(const SkillRun& run, const std::vector<RunSkill>& skills,
                         const ChainRecording& recording);

// The episode as lines of JSON, one a control step: joints of the robot, poses and joints of things
// (docs/formats.md).
std::string RolloutPoses(const SkillRun& run, const std::vector<RunSkill>& skills,
                         const ChainRecording& recording);

}  // namespace simwright::pipeline
