#include "manipulation/tool_path.h"

#include <algorithm>

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;

constexpr double kPosition = 0.01;  // m, tolerance
constexpr double kStride = 0.03;    // m of the tool between steps
constexpr double kTurn = 0.12;      // rad
constexpr double kJointStep = 0.1;  // rad or m of any joint per step

}  // namespace

CartesianFollower::CartesianFollower(const PlanningArm& context, const Interaction& interaction,
                                     const robot::JointVector& from)
    : context_(context),
      base_from_world_(interaction.subtask.start.world_from_robot.inverse()),
      step_(robot::JointVector::Constant(from.size(), kJointStep)),
      configuration_(from) {}

bool CartesianFollower::MoveTo(const Isometry3d& world_from_tool, double turned) {
  const Isometry3d target = base_from_world_ * world_from_tool;
  const Isometry3d now = robot::ForwardKinematics(context_.robot->arm, configuration_);
  const Eigen::Quaterniond a(now.linear()), b(target.linear());
  const double distance = (target.translation() - now.translation()).norm();
  const int strides =
      1 + static_cast<int>(std::max(distance / kStride, a.angularDistance(b) / kTurn));
  robot::PoseError error;
  for (int i = 1; i <= strides + 4; ++i) {
    const double share = std::min(1.0, static_cast<double>(i) / strides);
    Isometry3d next = Isometry3d::Identity();
    next.translation() = now.translation() + share * (target.translation() - now.translation());
    next.linear() = a.slerp(share, b).toRotationMatrix();
    error = context_.kinematics->Track(next, step_, &configuration_);
  }
  return error.position < kPosition && error.angle < turned;
}

}  // namespace simwright::manipulation
