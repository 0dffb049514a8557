#pragma once

#include <vector>

#include "pipeline/skill_notes.h"
#include "robot/joint_trajectory.h"

namespace simwright::pipeline {

// The run with its skills prepared for replay: a command every step of the physics, in place of
// one every few, so that nothing is lost of a trajectory sampled at 1 kHz.
SkillRun AtPhysicsRate(const SkillRun& run);

// Drives the robot by the positions of `trajectory` alone, from the start in `notes`, and says of
// each subtask, up to the first that failed, whether its success had held for the skill's
// hold_seconds at its end. Between two subtasks the world is built anew at rest from where the
// replay has brought things, as in a rollout. `skills`: those of AtPhysicsRate. Throws core::Error,
// naming `where`, where the joints are not the robot's, the start does not fit, or the trajectory
// ends before its last subtask.
std::vector<bool> ReplayTrajectory(const std::vector<RunSkill>& skills,
                                   const robot::JointTrajectory& trajectory,
                                   const SkillNotes& notes, const std::string& where);

}  // namespace simwright::pipeline
