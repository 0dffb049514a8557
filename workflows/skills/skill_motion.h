#pragma once

#include <map>
#include <string>
#include <vector>

#include "robot/joint_names.h"
#include "robot/limit_check.h"
#include "robot/retiming.h"
#include "workflows/skills/skill_recording.h"

namespace simwright::workflows {

// The times at which a subtask begins and ends in a motion, s.
struct SubtaskTimes {
  double begin = 0.0, end = 0.0;
};

// The motion that a controller tracks to reproduce a rollout.
struct SkillMotion {
  robot::Retimed retimed;  // the arm's joints and the gripper's first joint
  robot::LimitReport limits;
  std::vector<SubtaskTimes> subtasks;  // in the motion's own time
};

// A controller's own limits, by the robot's joint names.
using JointLimitsByName = std::map<std::string, robot::JointLimits>;

// The joints of a motion of `robot`, the arm's first, then the gripper's first joint: their limits
// as a controller checks them (the tighter ones of the robot's and `limits`), and which of them
// slide.
struct MotionJoints {
  std::vector<std::string> names;
  std::vector<robot::JointLimits> limits;
  std::vector<bool> sliding;
};
MotionJoints MotionJointsOf(const robot::RobotModel& robot, const JointLimitsByName& limits = {});

// Computes the motion of a recorded chain from the COMMANDS of arm and fingers, not the positions
// they reached. A real arm that tracks them exerts the forces of the simulated one, and fingers
// commanded to a position that an object blocks press on it: that is a grasp. After each subtask
// the command is constant for the skill's hold_seconds, for which its success must hold, and then
// moves in small steps to the start of the next one. The motion is retimed to the robot's limits
// and `limits`, as close to the commands and as fast as `options` say, and checked against them. A
// motion that is faster than its recording ends with its last command, which a controller holds, so
// its last subtask ends later than the motion. Throws core::Error, naming joint, time and value, if
// limits cannot be met.
SkillMotion MotionOf(const ChainRecording& recording, const skills::Skill& skill,
                     const robot::RetimingOptions& options = {},
                     const JointLimitsByName& limits = {});

}  // namespace simwright::workflows
