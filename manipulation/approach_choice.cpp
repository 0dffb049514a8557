#include "manipulation/approach_choice.h"

#include <algorithm>
#include <numbers>
#include <tuple>

#include "manipulation/gripper_penetration.h"
#include "manipulation/outer_section_grasp.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kSpacing = 0.01;              // m between the sampled points of the gripper
constexpr double kLargestPenetration = 0.008;  // m: a deeper penetration blocks the approach
constexpr double kSuccessShare = 0.8;  // share of a joint's range at which its tasks succeed
constexpr double kBackwards = 0.75;  // of the tool's axis, back at the robot: beyond an arm's reach
constexpr double kAlike = std::numbers::pi / 6.0;  // rad between an approach and a grasp like it
constexpr double kBetweenPads = 0.01;              // m from the axis of a part that turns in place
constexpr double kShallower = 0.003;        // m: a pull slides off fingertips, and not off pads
constexpr size_t kMostAlike = 4;            // grasps: the gripper is checked at each
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

// Returns true if the joint rotates the part about an axis that passes between the pads: only
// these, and not a lever arm, turn it.
bool TurnsInPlace(const Interaction& interaction, const Isometry3d& link_from_grasp) {
  const InteractionTarget& target = *interaction.target;
  const tasks::ArticulatedObject& object =
      interaction.model.objects[static_cast<size_t>(target.object)];
  const tasks::ObjectJoint& joint = object.joints[static_cast<size_t>(target.joint)];
  if (joint.type == reward::RewardJointType::kPrismatic) return false;
  const std::vector<Isometry3d> poses = tasks::LinkPosesOf(object, tasks::RestPositions(object));
  const Vector3d arm = (poses[static_cast<size_t>(joint.link)].inverse() *
                        poses[static_cast<size_t>(target.link)] * link_from_grasp)
                           .translation();
  return arm.cross(joint.axis).norm() < kBetweenPads;
}

// Returns a grasp of a part that turns in place as one of its outer section (GraspOfOuterSection).
Isometry3d OnOuterSection(const Interaction& interaction, const SurfacePoints& hand,
                          const Isometry3d& link_from_grasp) {
  const InteractionTarget& target = *interaction.target;
  if (target.pushes || !TurnsInPlace(interaction, link_from_grasp)) return link_from_grasp;
  double tip = 0.0;
  for (const Vector3d& point : hand.points) tip = std::max(tip, point.z());
  const sim::ArticulatedBody& body = interaction.bodies[static_cast<size_t>(target.object)]->body();
  return GraspOfOuterSection(body.links[static_cast<size_t>(target.link)].parts, link_from_grasp,
                             tip);
}

}  // namespace

std::vector<Isometry3d> WithProvedGrasps(const std::vector<Isometry3d>& approaches,
                                         const std::vector<Grasp>& grasps) {
  std::vector<Isometry3d> all;
  std::vector<bool> used(grasps.size());
  for (const Isometry3d& approach : approaches) {
    std::vector<std::tuple<double, double, size_t>> alike;
    for (size_t i = 0; i < grasps.size(); ++i) {
      const Isometry3d& tool = grasps[i].object_from_tool;
      const double deeper =
          (tool.translation() - approach.translation()).dot(approach.linear().col(2));
      if (used[i] || GraspAngle(approach, tool) > kAlike || deeper < -kShallower) continue;
      alike.emplace_back(-grasps[i].quality, (tool.translation() - approach.translation()).norm(),
                         i);
    }
    std::sort(alike.begin(), alike.end());
    if (alike.size() > kMostAlike) alike.resize(kMostAlike);
    for (const auto& [quality, distance, index] : alike) {
      used[index] = true;
      all.push_back(grasps[index].object_from_tool);
    }
    all.push_back(approach);
  }
  return all;
}

Isometry3d ChooseApproach(const robot::RobotModel& robot, const Interaction& interaction) {
  const SurfacePoints hand = GripperSurface(robot, kSpacing);
  std::vector<Isometry3d> approaches = interaction.target->approaches;
  for (Isometry3d& approach : approaches) approach = OnOuterSection(interaction, hand, approach);
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
