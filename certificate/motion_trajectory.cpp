#include "certificate/motion_trajectory.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "robot/limit_check.h"
#include "robot/retiming.h"

namespace simwright::certificate {
namespace {

constexpr double kRecordRate = 60.0;  // Hz of the path that is retimed
constexpr double kFingerShare = 0.8;  // of the fingers' speed limit

double SpeedOf(Phase phase, const TrajectoryOptions& options) {
  switch (phase) {
    case Phase::kReach:
      return options.joint_speed;
    case Phase::kCarry:
      return options.carry_speed;
    default:
      return options.approach_speed;
  }
}

// A path of configurations at uniform intervals: the arm's joints, then the gripper's first.
class TimedPath {
 public:
  TimedPath(const robot::RobotModel& robot, const TrajectoryOptions& options)
      : robot_(robot), options_(options) {
    Append(robot.home(), robot.gripper.open);
  }

  void Add(const PlanSegment& segment) {
    if (segment.waypoints.size() < 2) {
      Rest();
      MoveFingers(segment.leader);
      Rest();
      return;
    }
    const double step = SpeedOf(segment.phase, options_) / kRecordRate;
    double carried = 0.0;  // of the next step, so that short pieces do not slow the path down
    for (size_t i = 1; i < segment.waypoints.size(); ++i) {
      const robot::JointVector& from = segment.waypoints[i - 1];
      const robot::JointVector by = segment.waypoints[i] - from;
      const double length = by.lpNorm<Eigen::Infinity>();
      for (carried += step; carried < length; carried += step) {
        Append(from + (carried / length) * by, leader_);
      }
      carried -= step + length;
    }
    Append(segment.waypoints.back(), leader_);
  }

  // Moves the fingers while the arm rests.
  void MoveFingers(double leader) {
    const auto joint = static_cast<size_t>(robot_.gripper.joints.front());
    const double step = kFingerShare * robot_.limits[joint].velocity / kRecordRate;
    const int steps = static_cast<int>(std::ceil(std::abs(leader - leader_) / step));
    const double from = leader_;
    for (int i = 1; i <= steps; ++i) Append(arm_, from + (leader - from) * i / steps);
    leader_ = leader;
  }
  void Rest() {
    const int count = static_cast<int>(std::ceil(options_.rest * kRecordRate));
    for (int i = 0; i < count; ++i) Append(arm_, leader_);
  }

  size_t size() const { return rows_.size(); }
  robot::RecordedPath Path() const {
    robot::RecordedPath path;
    path.positions.resize(static_cast<Eigen::Index>(rows_.size()), arm_.size() + 1);
    for (size_t k = 0; k < rows_.size(); ++k) {
      path.times.push_back(static_cast<double>(k) / kRecordRate);
      path.positions.row(static_cast<Eigen::Index>(k)) = rows_[k].transpose();
    }
    for (const robot::ArmJoint& joint : robot_.arm.joints) path.joints.push_back(joint.name);
    path.joints.push_back(
        robot_.urdf.joints[static_cast<size_t>(robot_.gripper.joints.front())].name);
    return path;
  }

 private:
  void Append(const robot::JointVector& arm, double leader) {
    arm_ = arm;
    leader_ = leader;
    Eigen::VectorXd row(arm.size() + 1);
    row << arm, leader;
    rows_.push_back(row);
  }

  const robot::RobotModel& robot_;
  const TrajectoryOptions& options_;
  robot::JointVector arm_;
  double leader_ = 0.0;
  std::vector<Eigen::VectorXd> rows_;
};

}  // namespace

bool TrajectoryOptions::IsValid(std::string* error) const {
  const bool valid = rate >= 20.0 && rate <= 5000.0 && joint_speed > 0.0 && approach_speed > 0.0 &&
                     carry_speed > 0.0 && rest >= 0.0;
  if (!valid && error != nullptr) {
    *error = "the rate must be 20 to 5000 Hz, speeds positive and the rest not negative";
  }
  return valid;
}

TimedMotion TrajectoryOf(const MotionPlan& plan, const robot::RobotModel& robot,
                         const TrajectoryOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "trajectory");
  TimedPath path(robot, options);
  if (!plan.segments.empty()) path.MoveFingers(plan.segments.front().leader);
  std::vector<size_t> ends;
  for (const PlanSegment& segment : plan.segments) {
    path.Add(segment);
    ends.push_back(path.size() - 1);
  }
  path.Rest();
  std::vector<robot::JointLimits> limits;
  std::vector<bool> sliding;
  for (const robot::ArmJoint& joint : robot.arm.joints) sliding.push_back(joint.prismatic);
  for (const int joint : robot.arm_joints)
    limits.push_back(robot.limits[static_cast<size_t>(joint)]);
  const auto leader = static_cast<size_t>(robot.gripper.joints.front());
  sliding.push_back(robot.urdf.joints[leader].type == assets::JointType::kPrismatic);
  limits.push_back(robot.limits[leader]);
  for (robot::JointLimits& limit : limits) limit = robot::CommandLimits(limit, robot.margin);
  robot::RetimingOptions retiming;
  retiming.rate = options.rate;
  const robot::Retimed retimed = robot::Retime(path.Path(), limits, sliding, &robot.arm, retiming);
  const robot::LimitReport report = robot::CheckLimits(retimed.trajectory, limits);
  if (!report.accepted()) {
    throw core::Error(report.findings.front().sentence, report.findings.front().place,
                      "the robot would reject it");
  }
  TimedMotion motion;
  motion.trajectory = retimed.trajectory;
  for (size_t i = 0; i < ends.size(); ++i) {
    motion.phases.push_back({plan.segments[i].phase, retimed.waypoint_times[ends[i]]});
  }
  return motion;
}

}  // namespace simwright::certificate
