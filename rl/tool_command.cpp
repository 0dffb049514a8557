#include "rl/tool_command.h"

#include <algorithm>
#include <cmath>

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// In front of the robot, pointing down: zero of ActionSpace::kAbsolute.
Isometry3d InFront() {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(0.5, 0.0, 0.3);
  pose.linear() = Vector3d(1.0, -1.0, -1.0).asDiagonal();
  return pose;
}
constexpr double kWorkspace = 0.5;  // m, of an offset of 1 with kAbsolute
constexpr double kOfSpeed = 0.9;    // of a joint's highest speed
constexpr double kGoalJump = 0.1;   // rad or m that any joint of the goal moves in a control step

Isometry3d Offset(const float* action, double reach, double turn) {
  const Vector3d shift(action[0], action[1], action[2]), spin(action[3], action[4], action[5]);
  Isometry3d offset = Isometry3d::Identity();
  offset.translation() = reach * shift;
  const double angle = turn * spin.norm();
  if (angle > 1e-9) offset.linear() = Eigen::AngleAxisd(angle, spin.normalized()).matrix();
  return offset;
}

// Wide open from -1/6 up, shut at -1: a policy that has learnt nothing yet does not knock its
// fingers against what it shall take.
double LeaderOf(const robot::Gripper& gripper, double action) {
  const double share = std::clamp(1.2 + 1.2 * action, 0.0, 1.0);
  return gripper.closed + share * (gripper.open - gripper.closed);
}

// The share of `way` (J) that an arm at `posture` goes in `seconds`.
double ShareOf(const Skill& skill, const robot::Posture& posture, const robot::Posture& way,
               double seconds) {
  const robot::RobotModel& robot = *skill.robot;
  double share = 1.0;
  for (Eigen::Index j = 0; j < way.size(); ++j) {
    const auto joint = static_cast<size_t>(robot.arm_joints[static_cast<size_t>(j)]);
    const double most = kOfSpeed * seconds * robot.limits[joint].velocity;
    if (std::abs(way[j]) * share > most) share = most / std::abs(way[j]);
  }
  robot::ToolJacobian jacobian;
  skill.chain->Tool(posture, &jacobian);
  const Eigen::Matrix<double, 6, 1> tool = jacobian * way;
  const double shift = tool.head<3>().norm(), turn = tool.tail<3>().norm();
  if (shift * share > skill.options.tool_speed * seconds) {
    share = skill.options.tool_speed * seconds / shift;
  }
  if (turn * share > skill.options.turn_speed * seconds) {
    share = skill.options.turn_speed * seconds / turn;
  }
  return share;
}

}  // namespace

int ActionSize(const Skill& skill) {
  return skill.options.action == ActionSpace::kJoints ? skill.robot->arm.size() + 1 : 7;
}

ToolTarget TargetOf(const Skill& skill, const float* action, const Isometry3d& base_from_focus,
                    const robot::Posture& command) {
  const SkillOptions& options = skill.options;
  ToolTarget target;
  target.leader = LeaderOf(skill.robot->gripper, action[ActionSize(skill) - 1]);
  switch (options.action) {
    case ActionSpace::kFocus:
      target.base_from_tool = base_from_focus * Offset(action, options.reach, options.turn);
      break;
    case ActionSpace::kAbsolute:
      target.base_from_tool = InFront() * Offset(action, kWorkspace, M_PI);
      break;
    case ActionSpace::kDelta: {
      const double share = options.delta_share;
      const Isometry3d offset = Offset(action, share * options.reach, share * options.turn);
      const Isometry3d now = robot::ForwardKinematics(skill.robot->arm, command);
      target.base_from_tool.translation() = now.translation() + offset.translation();
      target.base_from_tool.linear() = offset.linear() * now.linear();
      break;
    }
    case ActionSpace::kJoints:
      target.joints = command;
      for (Eigen::Index j = 0; j < command.size(); ++j) {
        const robot::ArmJoint& joint = skill.robot->arm.joints[static_cast<size_t>(j)];
        const double step =
            options.delta_share * (joint.prismatic ? options.reach : 0.5 * options.turn);
        target.joints[j] = std::clamp(command[j] + step * action[j], joint.lower, joint.upper);
      }
      break;
  }
  return target;
}

void Approach(const Skill& skill, const ToolTarget& target, const robot::Posture& actual,
              ArmCommand* command) {
  const SkillOptions& options = skill.options;
  const double dt = 1.0 / options.control_rate;
  if (options.action == ActionSpace::kJoints) {
    command->goal = target.joints;
  } else {
    const robot::Posture jump = robot::Posture::Constant(actual.size(), kGoalJump);
    skill.kinematics->Track(target.base_from_tool, jump, &command->goal);
  }
  const robot::Posture way = command->goal - command->sent;
  command->sent += ShareOf(skill, command->sent, way, dt) * way;
  for (Eigen::Index j = 0; j < actual.size(); ++j) {
    command->sent[j] = std::clamp(command->sent[j], actual[j] - options.longest_lead,
                                  actual[j] + options.longest_lead);
  }
  const robot::RobotModel& robot = *skill.robot;
  const auto first = static_cast<size_t>(robot.gripper.joints.front());
  const double finger = dt * robot.limits[first].velocity;
  command->leader += std::clamp(target.leader - command->leader, -finger, finger);
}

}  // namespace simwright::rl
