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
// Of a joint's highest acceleration. The rest is for what smooths the corners between control steps
// (robot/retiming.h).
constexpr double kOfAcceleration = 0.7;
// How the standoff grows: a cone about the focus' axis, wide enough for what exploration asks for.
constexpr double kBeside = 0.025, kSlope = 2.0;   // m off the axis that are free; m a m
constexpr double kTurned = 0.4, kPerTurn = 0.15;  // rad that are free; m a rad
constexpr double kNearlyBack = 0.03;              // m less than it shall stay back, that is as far
constexpr double kAbove = 0.015;  // m: a hand so far above its work comes down before it pushes
// m: so far ahead of the focus a hand still pushes. Were it lifted there, it would drag the side of
// the thing that it touches upwards, and tip it.
constexpr double kAhead = 0.05;
constexpr double kDecided = 0.15;  // of an action: less leaves the fingers as they are
constexpr double kPassed = 0.05;   // rad or m of any joint: a posture on the way has been passed
constexpr double kGoalJump = 0.1;  // rad or m that any joint of the goal moves in a control step

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

// Of the tool as it was sent last, in the focus' frame.
Isometry3d InFocus(const Skill& skill, const WorkFrame& frame, const ArmCommand& command) {
  return frame.base_from_focus.inverse() * robot::ForwardKinematics(skill.robot->arm, command.sent);
}

// m that the tool stays back: more, the farther it is off the focus' axis and the more it is
// turned.
double Standoff(const Skill& skill, const WorkFrame& frame, const Isometry3d& off) {
  const Vector3d& back = frame.back;
  Vector3d beside = off.translation() - off.translation().dot(back) * back;
  Vector3d way = frame.free_way - frame.free_way.dot(back) * back;
  if (frame.pushes) {
    beside.x() = std::max(0.0, beside.x() - kAhead);
    way.setZero();
  }
  const double counted = (beside - std::max(0.0, beside.dot(way)) * way).norm();
  const double aside = std::max(0.0, counted - kBeside);
  const Eigen::AngleAxisd turn(off.linear() * Leaning(-frame.lean));
  const double turned = std::max(0.0, turn.angle() - kTurned);
  return std::min(std::max(skill.options.standoff, frame.room_depth),
                  kSlope * aside + kPerTurn * turned);
}

// A tool at `now` that is not yet as far back as it shall stay goes back before it goes aside: what
// is about a room, its walls and its open door, is between it and the opening.
void LeaveStraight(const Vector3d& now, double standoff, const Vector3d& back, Isometry3d* offset) {
  const double along = now.dot(back);
  if (along > standoff - kNearlyBack) return;
  offset->translation() = now + (offset->translation().dot(back) - along) * back;
}

// The hand opens, closes, or stays as it is. Were the action an opening, with zero wide open, a
// policy that has learnt nothing would let go of whatever it holds, and would never close on a thin
// wall: that asked for -0.9, so that no cup was taken by its rim in 170k decisions.
double LeaderOf(const robot::Gripper& gripper, double action, double now) {
  if (action > kDecided) return gripper.open;
  if (action < -kDecided) return gripper.closed;
  return now;
}

// The highest speed from which a command that is slowed down by `acceleration` in steps of `dt`
// still stops within `distance`: v dt + (v - a dt) dt + ... = v^2 / 2 a + v dt / 2.
double StoppingSpeed(double distance, double acceleration, double dt) {
  const double step = acceleration * dt;
  return 0.5 * (std::sqrt(step * step + 8.0 * acceleration * distance) - step);
}

// The speed (J) that goes straight along `way` (J), as fast as options, joints and the stop at its
// end allow, by `pace` slower.
robot::Posture WantedRate(const Skill& skill, const robot::Posture& posture,
                          const robot::Posture& way, double pace) {
  const robot::RobotModel& robot = *skill.robot;
  const double dt = 1.0 / skill.options.control_rate;
  double rate = skill.options.control_rate;  // of the way, 1/s: no farther than its end
  for (Eigen::Index j = 0; j < way.size(); ++j) {
    const double length = std::abs(way[j]);
    if (length == 0.0) continue;
    const robot::JointLimits& limits =
        robot.limits[static_cast<size_t>(robot.arm_joints[static_cast<size_t>(j)])];
    const double most =
        std::min(pace * kOfSpeed * limits.velocity,
                 StoppingSpeed(length, pace * kOfAcceleration * limits.acceleration, dt));
    rate = std::min(rate, most / length);
  }
  robot::ToolJacobian jacobian;
  skill.chain->Tool(posture, &jacobian);
  const Eigen::Matrix<double, 6, 1> tool = jacobian * way;
  const double shift = tool.head<3>().norm(), turn = tool.tail<3>().norm();
  if (shift * rate > pace * skill.options.tool_speed) {
    rate = pace * skill.options.tool_speed / shift;
  }
  if (turn * rate > pace * skill.options.turn_speed) rate = pace * skill.options.turn_speed / turn;
  return rate * way;
}

// `rate` after one step towards `wanted`.
double Accelerated(double rate, double wanted, const robot::JointLimits& limits, double dt,
                   double pace = 1.0) {
  const double most = pace * kOfAcceleration * limits.acceleration * dt;
  return rate + std::clamp(wanted - rate, -most, most);
}

void MoveArm(const Skill& skill, const robot::Posture& goal, const robot::Posture& actual,
             ArmCommand* command) {
  const double dt = 1.0 / skill.options.control_rate, lead = skill.options.longest_lead;
  const robot::Posture wanted =
      WantedRate(skill, command->sent, goal - command->sent, command->pace);
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
  const double way = target - command->leader;
  const double most =
      std::min({limits.velocity, std::abs(way) / dt,
                StoppingSpeed(std::abs(way), kOfAcceleration * limits.acceleration, dt)});
  command->leader_rate = Accelerated(command->leader_rate, std::copysign(most, way), limits, dt);
  command->leader += dt * command->leader_rate;
}

}  // namespace

int ActionSize(const Skill& skill) {
  return skill.options.action == ActionSpace::kJoints ? skill.robot->arm.size() + 1 : 7;
}

ToolTarget TargetOf(const Skill& skill, const float* action, const WorkFrame& frame,
                    const ArmCommand& command) {
  const SkillOptions& options = skill.options;
  ToolTarget target;
  target.leader = LeaderOf(skill.robot->gripper, action[ActionSize(skill) - 1], command.leader);
  switch (options.action) {
    case ActionSpace::kGuided:
    case ActionSpace::kFocus: {
      Isometry3d offset = Offset(action, options.reach, options.turn);
      offset.rotate(Leaning(frame.lean));
      if (options.standoff > 0.0) {
        const Isometry3d now = InFocus(skill, frame, command);
        if (frame.pushes && now.translation().z() < -kAbove) {
          offset.translation().x() = std::min(offset.translation().x(), 0.0);
        }
        const double standoff = Standoff(skill, frame, now);
        offset.translation() += standoff * frame.back;
        if (frame.room_depth > 0.0) LeaveStraight(now.translation(), standoff, frame.back, &offset);
      }
      target.base_from_tool = frame.base_from_focus * offset;
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
  }
  return target;
}

void Approach(const Skill& skill, const ToolTarget& target, const robot::Posture& actual,
              ArmCommand* command) {
  std::vector<robot::Posture>& via = command->via;
  if (!via.empty() && (via.front() - command->sent).lpNorm<Eigen::Infinity>() < kPassed) {
    via.erase(via.begin());
  }
  if (skill.options.action == ActionSpace::kJoints) {
    command->goal = target.joints;
  } else if (via.empty()) {  // until then the goal stays the posture that was planned
    const robot::Posture jump = robot::Posture::Constant(actual.size(), kGoalJump);
    skill.kinematics->Track(target.base_from_tool, jump, &command->goal,
                            command->rest.size() > 0 ? &command->rest : nullptr);
  }
  MoveArm(skill, via.empty() ? command->goal : via.front(), actual, command);
  MoveFingers(skill, target.leader, command);
}

}  // namespace simwright::rl
