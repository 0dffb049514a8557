#include "rl/approach_choice.h"

#include <algorithm>

#include "rl/hand_clearance.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kSpacing = 0.01;              // m between the sampled points of the gripper
constexpr double kLargestPenetration = 0.008;  // m: a deeper penetration blocks the approach
constexpr double kSuccessShare = 0.8;  // share of a joint's range at which its tasks succeed
constexpr double kBackwards = 0.75;  // of the tool's axis, back at the robot: beyond an arm's reach
constexpr double kFromBelow = 0.7;   // of the tool's axis, upwards

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
  return axis.z() < kFromBelow && axis.dot(away) > -kBackwards;
}

Fit FitOf(const Isometry3d& link_from_tool, const SurfacePoints& hand, const SkillVariant& variant,
          const sim::ArticulatedBody& body) {
  const Focus& focus = *variant.focus;
  const tasks::Thing& thing = variant.model.things[static_cast<size_t>(focus.thing)];
  const tasks::ThingJoint& joint = thing.joints[static_cast<size_t>(focus.joint)];
  const BodySolids& solids = variant.solids[static_cast<size_t>(focus.thing)];
  const int link = body.LinkIndex(thing.links[static_cast<size_t>(focus.link)].name);
  const Isometry3d& root = variant.start.roots[static_cast<size_t>(focus.thing)];
  Vector3d away = root.translation() - variant.subtask.start.world_from_robot.translation();
  away.z() = 0.0;
  away.normalize();
  Fit fit;
  for (const double share : {0.0, 0.5 * kSuccessShare, kSuccessShare}) {
    std::vector<double> joints = tasks::RestPositions(thing);
    joints[static_cast<size_t>(focus.joint)] = joint.rest() + share * (joint.far() - joint.rest());
    const std::vector<Isometry3d> poses = BodyPoses(body, thing, root, joints);
    const Isometry3d tool = poses[static_cast<size_t>(link)] * link_from_tool;
    fit.deepest = std::max(fit.deepest, DeepestPoint(hand, tool, solids, poses, link));
    fit.points_away = fit.points_away && PointsAway(tool, away);
  }
  return fit;
}

}  // namespace

Isometry3d ChooseApproach(const robot::RobotModel& robot, const SkillVariant& variant,
                          const sim::ArticulatedBody& body) {
  const SurfacePoints hand = HandSurface(robot, kSpacing);
  const std::vector<Isometry3d>& approaches = variant.focus->approaches;
  Isometry3d best = approaches.front();
  Fit best_fit;
  for (size_t i = 0; i < approaches.size(); ++i) {
    const Fit fit = FitOf(approaches[i], hand, variant, body);
    if (fit.Passes()) return approaches[i];
    if (i > 0 && !fit.IsBetterThan(best_fit)) continue;
    best_fit = fit;
    best = approaches[i];
  }
  return best;
}

}  // namespace simwright::rl
