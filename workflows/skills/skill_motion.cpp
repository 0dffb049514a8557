#include "workflows/skills/skill_motion.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::workflows {
namespace {

// The largest motion of a command per step from one subtask to the next; fingers move at their
// speed.
constexpr double kBridgeStep = 0.01;  // rad or m
constexpr double kAnyPace = 1e3;      // times the recording's pace

// A path of commands, one per control step.
class CommandPath {
 public:
  CommandPath(const skills::Skill& skill, const MotionJoints& joints)
      : rate_(skill.options.control_rate), steps_(Eigen::VectorXd::Constant(Joints(joints), 0.0)) {
    for (Eigen::Index j = 0; j < steps_.size(); ++j) {
      const robot::JointLimits& limits = joints.limits[static_cast<size_t>(j)];
      steps_[j] = std::min(kBridgeStep, 0.5 * limits.velocity / rate_);
    }
  }

  size_t size() const { return commands_.size(); }
  double seconds() const { return static_cast<double>(commands_.size()) / rate_; }
  void Add(const RecordedMoment& moment) {
    Eigen::VectorXd command(steps_.size());
    command << moment.arm_command, moment.leader_command;
    commands_.push_back(command);
  }
  // Appends a rest, whose duration does not depend on the speed of the motion.
  void Rest(double seconds) {
    paces_.resize(commands_.size(), kAnyPace);
    commands_.insert(commands_.end(), static_cast<size_t>(std::ceil(seconds * rate_)),
                     Eigen::VectorXd(commands_.back()));
    paces_.resize(commands_.size(), 1.0);
  }
  // Appends the steps to the command at `moment`.
  void Bridge(const RecordedMoment& moment) {
    const Eigen::VectorXd from = commands_.back();
    Add(moment);
    const Eigen::VectorXd displacement = commands_.back() - from;
    commands_.pop_back();
    const auto count =
        static_cast<int>(std::ceil((displacement.cwiseAbs().cwiseQuotient(steps_)).maxCoeff()));
    for (int i = 1; i < count; ++i) commands_.push_back(from + displacement * i / count);
  }

  robot::RecordedPath Path(const MotionJoints& joints) const {
    robot::RecordedPath path;
    path.joints = joints.names;
    path.positions.resize(static_cast<Eigen::Index>(commands_.size()), steps_.size());
    for (size_t k = 0; k < commands_.size(); ++k) {
      path.times.push_back(static_cast<double>(k) / rate_);
      path.positions.row(static_cast<Eigen::Index>(k)) = commands_[k].transpose();
    }
    path.speed_ups = paces_;
    path.speed_ups.resize(commands_.size(), kAnyPace);
    return path;
  }

 private:
  static Eigen::Index Joints(const MotionJoints& joints) {
    return static_cast<Eigen::Index>(joints.names.size());
  }

  double rate_;
  Eigen::VectorXd steps_;  // largest steps of a bridge, by joint
  std::vector<Eigen::VectorXd> commands_;
  std::vector<double> paces_;  // of the first commands; the others have any pace
};

void RequireAccepted(const robot::LimitReport& report) {
  if (report.accepted()) return;
  const core::Finding& finding = report.findings.front();
  throw core::Error(finding.sentence, finding.place, "the robot would reject it");
}

}  // namespace

MotionJoints MotionJointsOf(const robot::RobotModel& robot, const JointLimitsByName& tighter) {
  MotionJoints joints;
  for (int j = 0; j < robot.arm.size(); ++j) {
    const robot::ArmJoint& joint = robot.arm.joints[static_cast<size_t>(j)];
    joints.names.push_back(joint.name);
    joints.sliding.push_back(joint.prismatic);
    joints.limits.push_back(
        robot.limits[static_cast<size_t>(robot.arm_joints[static_cast<size_t>(j)])]);
  }
  const auto leader = static_cast<size_t>(robot.gripper.joints.front());
  joints.names.push_back(robot.urdf.joints[leader].name);
  joints.sliding.push_back(robot.urdf.joints[leader].type == assets::JointType::kPrismatic);
  joints.limits.push_back(robot.limits[leader]);
  for (size_t j = 0; j < joints.limits.size(); ++j) {
    const auto found = tighter.find(joints.names[j]);
    if (found != tighter.end()) {
      joints.limits[j] = robot::TighterLimits(joints.limits[j], found->second);
    }
    joints.limits[j] = robot::CommandLimits(joints.limits[j], robot.margin);
  }
  return joints;
}

SkillMotion MotionOf(const ChainRecording& recording, const skills::Skill& skill,
                     const robot::RetimingOptions& options, const JointLimitsByName& limits) {
  const MotionJoints joints = MotionJointsOf(*skill.robot, limits);
  // At the recording's pace the recorded motion already held its success for hold_seconds, and does
  // so once more; a faster motion passes that in no time and rests for the same total time.
  const double rest = (options.max_speed_up > 1.0 ? 2.0 : 1.0) * skill.options.hold_seconds;
  CommandPath commands(skill, joints);
  std::vector<std::pair<size_t, size_t>> spans;  // indices into the path
  for (const RecordedSubtask& subtask : recording.subtasks) {
    if (commands.size() > 0) commands.Bridge(subtask.moments.front());
    const size_t begin = commands.size();
    for (const RecordedMoment& moment : subtask.moments) commands.Add(moment);
    const bool last = &subtask == &recording.subtasks.back();
    // A controller holds the last command by itself.
    if (!last || options.max_speed_up <= 1.0) commands.Rest(rest);
    spans.emplace_back(begin, commands.size() - 1);
  }
  SkillMotion motion;
  motion.retimed = robot::Retime(commands.Path(joints), joints.limits, joints.sliding,
                                 &skill.robot->arm, options);
  motion.limits = robot::CheckLimits(motion.retimed.trajectory, joints.limits);
  RequireAccepted(motion.limits);
  for (const auto& [begin, end] : spans) {
    motion.subtasks.push_back({begin == 0 ? 0.0 : motion.retimed.waypoint_times[begin],
                               motion.retimed.waypoint_times[end]});
  }
  if (options.max_speed_up > 1.0) motion.subtasks.back().end += rest;
  return motion;
}

}  // namespace simwright::workflows
