#include "manipulation/approach_choice.h"

#include <algorithm>

#include "manipulation/gripper_penetration.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kSpacing = 0.01;              // m between the sampled points of the gripper
constexpr double kLargestPenetration = 0.008;  // m: a deeper penetration blocks the approach
constexpr double kSuccessShare = 0.8;  // share of a joint's range at which its tasks succeed
constexpr double kBackwards = 0.75;  // of the tool's axis, back at the robot: beyond an arm's reach
constexpr double kApproachFromBelow = 0.7;  // of the tool's axis, upwards

// The quality of an approach over the joint's motion.
struct Fit {
  double deepest = 0.0;     // m, penetration of the gripper's points
  bool points_away = true;  // points neither back at the robot nor upwards

  bool Passes() const { return points_away && deepest < kLargestPenetration; }
  bool IsBetterThan(const Fit& other) const {
    return points_away != other.points_away ? points_away : deepest < other.deepest;
  }
};

// `away`: the direction from the robot to the object.
bool PointsAway(const Isometry3d& world_from_tool, const Vector3d& away) {
  const Vector3d axis = world_from_tool.linear().col(2);
  return axis.z() < kApproachFromBelow && axis.dot(away) > -kBackwards;
}

Fit FitOf(const Isometry3d& link_from_grasp, const SurfacePoints& hand,
          const Interaction& interaction) {
  const InteractionTarget& target = *interaction.target;
  const tasks::ArticulatedObject& object =
      interaction.model.objects[static_cast<size_t>(target.object)];
  const tasks::ObjectJoint& joint = object.joints[static_cast<size_t>(target.joint)];
  const BodyParts& solids = interaction.solids[static_cast<size_t>(target.object)];
  const Isometry3d& root = interaction.start.roots[static_cast<size_t>(target.object)];
  Vector3d away = root.translation() - interaction.subtask.start.world_from_robot.translation();
  away.z() = 0.0;
  away.normalize();
  Fit fit;
  for (const double share : {0.0, 0.5 * kSuccessShare, kSuccessShare}) {
    std::vector<double> joints = tasks::RestPositions(object);
    joints[static_cast<size_t>(target.joint)] = joint.rest() + share * (joint.far() - joint.rest());
    const std::vector<Isometry3d> poses = WorldLinkPoses(object, root, joints);
    const Isometry3d tool = poses[static_cast<size_t>(target.link)] * link_from_grasp;
    fit.deepest = std::max(fit.deepest, PenetrationDepth(hand, tool, solids, poses, target.link));
    fit.points_away = fit.points_away && PointsAway(tool, away);
  }
  return fit;
}

}  // namespace

Isometry3d ChooseApproach(const robot::RobotModel& robot, const Interaction& interaction) {
  const SurfacePoints hand = GripperSurface(robot, kSpacing);
  const std::vector<Isometry3d>& approaches = interaction.target->approaches;
  Isometry3d best = approaches.front();
  Fit best_fit;
  for (size_t i = 0; i < approaches.size(); ++i) {
    const Fit fit = FitOf(approaches[i], hand, interaction);
    if (fit.Passes()) return approaches[i];
    if (i > 0 && !fit.IsBetterThan(best_fit)) continue;
    best_fit = fit;
    best = approaches[i];
  }
  return best;
}

}  // namespace simwright::manipulation
