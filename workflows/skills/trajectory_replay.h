#pragma once

#include <vector>

#include "robot/joint_trajectory.h"
#include "workflows/skills/skill_metadata.h"

namespace simwright::workflows {

// Returns the run with one command per physics step instead of one every few steps, so that a
// trajectory sampled at 1 kHz replays without loss.
SkillRun AtPhysicsRate(const SkillRun& run);

// Drives the robot with the positions of `trajectory` alone, from the start in `metadata`, and
// reports for each subtask, up to the first failed one, whether its success held for the skill's
// hold_seconds at its end. Between two subtasks the world is rebuilt at rest from the state that
// the replay has reached, as in a rollout. `skills`: those of AtPhysicsRate. Throws core::Error,
// naming `where`, if the joints are not the robot's, the start does not match, or the trajectory
// ends before its last subtask.
std::vector<bool> ReplayTrajectory(const std::vector<RunSkill>& skills,
                                   const robot::JointTrajectory& trajectory,
                                   const SkillMetadata& metadata, const std::string& where);

// Replays from `start`, a start of the first skill, instead; `times`: of the subtasks.
std::vector<bool> ReplayTrajectoryFrom(const std::vector<RunSkill>& skills,
                                       const robot::JointTrajectory& trajectory,
                                       const std::vector<SubtaskTimes>& times,
                                       skills::StartState start, const std::string& where);

}  // namespace simwright::workflows
