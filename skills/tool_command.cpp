#include "skills/tool_command.h"

#include <algorithm>
#include <cmath>

namespace simwright::skills {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Returns the pose at zero of ActionSpace::kAbsolute: in front of the robot, pointing down.
Isometry3d InFront() {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(0.5, 0.0, 0.3);
  pose.linear() = Vector3d(1.0, -1.0, -1.0).asDiagonal();
  return pose;
}
constexpr double kWorkspace = 0.5;  // m, for an offset of 1 with kAbsolute
constexpr double kOfSpeed = 0.9;    // share of a joint's velocity limit
// The share of a joint's acceleration limit. The rest is reserved for smoothing between control
// steps (robot/retiming.h).
constexpr double kOfAcceleration = 0.7;
// The growth of the standoff: a cone about the target frame's axis, wide enough for exploration.
constexpr double kToolFreeLateral = 0.025,
                 kSlope = 2.0;                    // m off the axis without standoff; m per m
constexpr double kTurned = 0.4, kPerTurn = 0.15;  // rad without standoff; m per rad
constexpr double kNearlyBack = 0.03;              // m, tolerance of the standoff
constexpr double kAbove = 0.015;                  // m: a higher gripper comes down before it pushes
// The distance (m) ahead of the target up to which a gripper still pushes. If it were lifted there,
// it would drag the side of the object upwards and tip it.
constexpr double kCommandLead = 0.05;
constexpr double kFingerThreshold = 0.15;  // of an action: below, the fingers stay
constexpr double kPassed = 0.05;           // rad or m of any joint: the waypoint has been passed
constexpr double kGoalJump = 0.1;  // rad or m, motion of the goal per joint and control step

Isometry3d Offset(const float* action, double reach, double turn) {
  const Vector3d shift(action[0], action[1], action[2]), spin(action[3], action[4], action[5]);
  Isometry3d offset = Isometry3d::Identity();
  offset.translation() = reach * shift;
  const double angle = turn * spin.norm();
  if (angle > 1e-9) offset.linear() = Eigen::AngleAxisd(angle, spin.normalized()).matrix();
  return offset;
}

Eigen::Matrix3d Leaning(double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix();
}

// Returns the tool pose of the last command in the target frame.
Isometry3d LastCommandInTargetFrame(const Skill& skill, const ActionFrame& frame,
                                    const ArmCommand& command) {
  return frame.base_from_target.inverse() *
         robot::ForwardKinematics(skill.robot->arm, command.sent);
}

// Returns the standoff (m) of the tool: it grows with the lateral offset and the rotation from the
// target frame.
double Standoff(const Skill& skill, const ActionFrame& frame, const Isometry3d& off) {
  const Vector3d& back = frame.back;
  Vector3d lateral = off.translation() - off.translation().dot(back) * back;
  Vector3d direction = frame.motion_direction - frame.motion_direction.dot(back) * back;
  if (frame.pushes) {
    lateral.x() = std::max(0.0, lateral.x() - kCommandLead);
    direction.setZero();
  }
  const double counted = (lateral - std::max(0.0, lateral.dot(direction)) * direction).norm();
  const double aside = std::max(0.0, counted - kToolFreeLateral);
  const Eigen::AngleAxisd turn(off.linear() * Leaning(-frame.lean));
  const double turned = std::max(0.0, turn.angle() - kTurned);
  return std::min(std::max(skill.options.standoff, frame.retreat_distance),
                  kSlope * aside + kPerTurn * turned);
}

// Makes a tool at `now` that is not yet back at its standoff move back before it moves sideways:
// walls and the open door of a receptacle are between it and the opening.
void LeaveStraight(const Vector3d& now, double standoff, const Vector3d& back, Isometry3d* offset) {
  const double along = now.dot(back);
  if (along > standoff - kNearlyBack) return;
  offset->translation() = now + (offset->translation().dot(back) - along) * back;
}

// Returns the finger target: the gripper opens, closes, or stays. With the action as an absolute
// opening, zero being wide open, an untrained policy would release whatever it grasps, and would
// hardly ever close on a thin wall.
double LeaderOf(const robot::Gripper& gripper, double action, double now) {
  if (action > kFingerThreshold) return gripper.open;
  if (action < -kFingerThreshold) return gripper.closed;
  return now;
}

// Returns the highest speed from which a command decelerating by `acceleration` in steps of `dt`
// still stops within `distance`: v dt + (v - a dt) dt + ... = v^2 / 2 a + v dt / 2.
double StoppingSpeed(double distance, double acceleration, double dt) {
  const double step = acceleration * dt;
  return 0.5 * (std::sqrt(step * step + 8.0 * acceleration * distance) - step);
}

// Returns the joint velocity (J) straight along `displacement` (J), as fast as options, joint
// limits and the stop at its end allow, scaled by `pace`.
robot::JointVector WantedRate(const Skill& skill, const robot::JointVector& configuration,
                              const robot::JointVector& displacement, double pace) {
  const robot::RobotModel& robot = *skill.robot;
  const double dt = 1.0 / skill.options.control_rate;
  double rate = skill.options.control_rate;  // of the displacement, 1/s: no farther than its end
  for (Eigen::Index j = 0; j < displacement.size(); ++j) {
    const double length = std::abs(displacement[j]);
    if (length == 0.0) continue;
    const robot::JointLimits& limits =
        robot.limits[static_cast<size_t>(robot.arm_joints[static_cast<size_t>(j)])];
    const double most =
        std::min(pace * kOfSpeed * limits.velocity,
                 StoppingSpeed(length, pace * kOfAcceleration * limits.acceleration, dt));
    rate = std::min(rate, most / length);
  }
  robot::ToolJacobian jacobian;
  skill.chain->Tool(configuration, &jacobian);
  const Eigen::Matrix<double, 6, 1> tool = jacobian * displacement;
  const double shift = tool.head<3>().norm(), turn = tool.tail<3>().norm();
  if (shift * rate > pace * skill.options.tool_speed) {
    rate = pace * skill.options.tool_speed / shift;
  }
  if (turn * rate > pace * skill.options.turn_speed) rate = pace * skill.options.turn_speed / turn;
  return rate * displacement;
}

// Returns `rate` after one step of acceleration towards `wanted`.
double Accelerated(double rate, double wanted, const robot::JointLimits& limits, double dt,
                   double pace = 1.0) {
  const double most = pace * kOfAcceleration * limits.acceleration * dt;
  return rate + std::clamp(wanted - rate, -most, most);
}

// Returns the share of the way from the rates of `command` to `wanted` (J) that all joints can be
// accelerated by in one step.
double CommonShare(const Skill& skill, const robot::JointVector& wanted,
                   const ArmCommand& command) {
  const double dt = 1.0 / skill.options.control_rate;
  double share = 1.0;
  for (Eigen::Index j = 0; j < wanted.size(); ++j) {
    const auto index = static_cast<size_t>(skill.robot->arm_joints[static_cast<size_t>(j)]);
    const double reached =
        Accelerated(command.rate[j], wanted[j], skill.robot->limits[index], dt, command.pace);
    const double missing = wanted[j] - command.rate[j];
    if (missing != 0.0) share = std::min(share, (reached - command.rate[j]) / missing);
  }
  return share;
}

void MoveArm(const Skill& skill, const robot::JointVector& goal, const robot::JointVector& actual,
             ArmCommand* command) {
  const double dt = 1.0 / skill.options.control_rate, lead = skill.options.longest_lead;
  robot::JointVector wanted = WantedRate(skill, command->sent, goal - command->sent, command->pace);
  if (command->together) {
    wanted = command->rate + CommonShare(skill, wanted, *command) * (wanted - command->rate);
  }
  for (Eigen::Index j = 0; j < actual.size(); ++j) {
    const robot::ArmJoint& joint = skill.robot->arm.joints[static_cast<size_t>(j)];
    const auto index = static_cast<size_t>(skill.robot->arm_joints[static_cast<size_t>(j)]);
    const double ahead = command->sent[j] - actual[j];
    const double held = std::clamp(wanted[j], std::min(0.0, (-lead - ahead) / dt),
                                   std::max(0.0, (lead - ahead) / dt));
    double& rate = command->rate[j];
    rate = Accelerated(rate, held, skill.robot->limits[index], dt, command->pace);
    const double from = command->sent[j];
    command->sent[j] = std::clamp(from + dt * rate, joint.lower, joint.upper);
    rate = (command->sent[j] - from) / dt;
  }
}

void MoveFingers(const Skill& skill, double target, ArmCommand* command) {
  const double dt = 1.0 / skill.options.control_rate;
  const robot::RobotModel& robot = *skill.robot;
  const robot::JointLimits& limits =
      robot.limits[static_cast<size_t>(robot.gripper.joints.front())];
  const double displacement = target - command->leader;
  const double most =
      std::min({limits.velocity, std::abs(displacement) / dt,
                StoppingSpeed(std::abs(displacement), kOfAcceleration * limits.acceleration, dt)});
  command->leader_rate =
      Accelerated(command->leader_rate, std::copysign(most, displacement), limits, dt);
  command->leader += dt * command->leader_rate;
}

}  // namespace

int ActionSize(const Skill& skill) {
  return CommandsJoints(skill.options.action) ? skill.robot->arm.size() + 1 : 7;
}

ToolTarget ActionTarget(const Skill& skill, const float* action, const ActionFrame& frame,
                        const ArmCommand& command) {
  const SkillOptions& options = skill.options;
  ToolTarget target;
  target.leader = LeaderOf(skill.robot->gripper, action[ActionSize(skill) - 1], command.leader);
  switch (options.action) {
    case ActionSpace::kGuided:
    case ActionSpace::kTargetFrame: {
      Isometry3d offset = Offset(action, options.reach, options.turn);
      offset.rotate(Leaning(frame.lean));
      if (options.standoff > 0.0) {
        const Isometry3d now = LastCommandInTargetFrame(skill, frame, command);
        if (frame.pushes && now.translation().z() < -kAbove) {
          offset.translation().x() = std::min(offset.translation().x(), 0.0);
        }
        const double standoff = Standoff(skill, frame, now);
        offset.translation() += standoff * frame.back;
        if (frame.retreat_distance > 0.0)
          LeaveStraight(now.translation(), standoff, frame.back, &offset);
      }
      target.base_from_tool = frame.base_from_target * offset;
      break;
    }
    case ActionSpace::kAbsolute:
      target.base_from_tool = InFront() * Offset(action, kWorkspace, M_PI);
      break;
    case ActionSpace::kDelta: {
      const double share = options.delta_share;
      const Isometry3d offset = Offset(action, share * options.reach, share * options.turn);
      const Isometry3d now = robot::ForwardKinematics(skill.robot->arm, command.sent);
      target.base_from_tool.translation() = now.translation() + offset.translation();
      target.base_from_tool.linear() = offset.linear() * now.linear();
      break;
    }
    case ActionSpace::kJoints:
      target.joints = command.sent;
      for (Eigen::Index j = 0; j < target.joints.size(); ++j) {
        const robot::ArmJoint& joint = skill.robot->arm.joints[static_cast<size_t>(j)];
        const double step =
            options.delta_share * (joint.prismatic ? options.reach : 0.5 * options.turn);
        target.joints[j] = std::clamp(command.sent[j] + step * action[j], joint.lower, joint.upper);
      }
      break;
    case ActionSpace::kJointTargets:
      target.joints = command.sent;
      for (Eigen::Index j = 0; j < target.joints.size(); ++j) {
        const robot::ArmJoint& joint = skill.robot->arm.joints[static_cast<size_t>(j)];
        target.joints[j] =
            0.5 * (joint.lower + joint.upper + action[j] * (joint.upper - joint.lower));
      }
      break;
  }
  return target;
}

void StepCommand(const Skill& skill, const ToolTarget& target, const robot::JointVector& actual,
                 ArmCommand* command) {
  std::vector<robot::JointVector>& waypoints = command->waypoints;
  if (!waypoints.empty() &&
      (waypoints.front() - command->sent).lpNorm<Eigen::Infinity>() < kPassed) {
    waypoints.erase(waypoints.begin());
  }
  if (CommandsJoints(skill.options.action)) {
    command->goal = target.joints;
  } else if (waypoints.empty()) {  // until then the goal stays the planned configuration
    const robot::JointVector jump = robot::JointVector::Constant(actual.size(), kGoalJump);
    skill.kinematics->Track(target.base_from_tool, jump, &command->goal,
                            command->rest.size() > 0 ? &command->rest : nullptr);
  }
  MoveArm(skill, waypoints.empty() ? command->goal : waypoints.front(), actual, command);
  MoveFingers(skill, target.leader, command);
}

}  // namespace simwright::skills
