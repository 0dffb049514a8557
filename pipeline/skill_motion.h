#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/skill_recording.h"
#include "robot/joint_names.h"
#include "robot/limit_check.h"
#include "robot/retiming.h"

namespace simwright::pipeline {

// When a subtask begins and ends in a motion, s.
struct SubtaskTimes {
  double begin = 0.0, end = 0.0;
};

// What a controller tracks so that a rollout happens again.
struct SkillMotion {
  robot::Retimed retimed;  // the arm's joints and the gripper's first one
  robot::LimitReport limits;
  std::vector<SubtaskTimes> subtasks;  // in the motion's own time
};

// Limits of a controller's own, by the robot's names of its joints.
using JointLimitsByName = std::map<std::string, robot::JointLimits>;

// The joints of a motion of `robot`, their limits as a controller checks them, the tighter of the
// robot's and `limits`, and which slide: the arm's, then the gripper's first joint.
struct MotionJoints {
  std::vector<std::string> names;
  std::vector<robot::JointLimits> limits;
  std::vector<bool> sliding;
};
MotionJoints MotionJointsOf(const robot::RobotModel& robot, const JointLimitsByName& limits = {});

// The motion of a recorded chain: the COMMANDS of arm and fingers, not where they came to. A real
// arm that tracks them pushes and pulls as the simulated one did, and fingers that are sent to
// where a thing does not let them go press on it: that is what a grasp is. After each subtask the
// command rests for the skill's hold_seconds, which its success has to outlast, and then goes in
// small steps to where the next one begins. Retimed to the robot's limits and `limits`, as close to
// the commands and as fast as `options` say, and checked against them. A motion that is faster than
// its recording ends with its last command, which a controller holds: its last subtask ends later
// than the motion. Throws core::Error, naming joint, time and value, where limits cannot be met.
SkillMotion MotionOf(const ChainRecording& recording, const rl::Skill& skill,
                     const robot::RetimingOptions& options = {},
                     const JointLimitsByName& limits = {});

}  // namespace simwright::pipeline
