#include "rl/reach_plan.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "rl/observation.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPosition = 0.01, kAngle = 0.15;  // m, rad: what is off at most
constexpr double kStride = 0.03;                   // m of the tool between two looks
constexpr double kTurn = 0.12;                     // rad
constexpr double kJointStep = 0.1;                 // rad or m of any joint in one look
constexpr double kPitches[] = {0.0, 0.35, -0.35, 0.7, -0.7};
constexpr int kPostures = 4;  // that are tried with each

// Follows poses with the tracker that training uses.
class Follower {
 public:
  Follower(const Skill& skill, const SkillVariant& variant, const robot::Posture& from)
      : skill_(skill),
        base_from_world_(variant.subtask.start.world_from_robot.inverse()),
        step_(robot::Posture::Constant(from.size(), kJointStep)),
        posture_(from) {}

  // Whether the tool gets to `world_from_tool`.
  bool Goes(const Isometry3d& world_from_tool) {
    const Isometry3d target = base_from_world_ * world_from_tool;
    const Isometry3d now = robot::ForwardKinematics(skill_.robot->arm, posture_);
    const Eigen::Quaterniond a(now.linear()), b(target.linear());
    const double way = (target.translation() - now.translation()).norm();
    const int strides = 1 + static_cast<int>(std::max(way / kStride, a.angularDistance(b) / kTurn));
    robot::PoseError error;
    for (int i = 1; i <= strides + 4; ++i) {
      const double share = std::min(1.0, static_cast<double>(i) / strides);
      Isometry3d next = Isometry3d::Identity();
      next.translation() = now.translation() + share * (target.translation() - now.translation());
      next.linear() = a.slerp(share, b).toRotationMatrix();
      error = skill_.kinematics->Track(next, step_, &posture_);
    }
    return error.position < kPosition && error.angle < kAngle;
  }

 private:
  const Skill& skill_;
  Isometry3d base_from_world_;
  robot::Posture step_;
  robot::Posture posture_;
};

// From where the joint stands, to the end of its way that is farther, as far as it has to go.
std::vector<double> JointWay(const tasks::ThingJoint& joint, double position) {
  const double rest = joint.rest(), most = rest + 0.8 * (joint.far() - rest);
  const double end = std::abs(position - rest) > std::abs(position - most) ? rest : most;
  std::vector<double> way;
  for (int i = 1; i <= 6; ++i) way.push_back(position + (end - position) * i / 6.0);
  return way;
}

bool Works(const Skill& skill, const SkillVariant& variant, tasks::SceneState state,
           const Isometry3d& tool, double pitch, const robot::Posture& at_work) {
  Follower follower(skill, variant, at_work);
  const Focus& focus = *variant.focus;
  if (focus.joint < 0) {
    if (!variant.destination) return true;
    Isometry3d there = tool;
    there.translation() += WayToDestination(variant, state);
    return follower.Goes(there);
  }
  const auto thing = static_cast<size_t>(focus.thing), j = static_cast<size_t>(focus.joint);
  double yaw = ToolYaw(tool);
  for (const double position :
       JointWay(variant.model.things[thing].joints[j], state.joints[thing][j])) {
    state.joints[thing][j] = position;
    const Isometry3d next = ToolAtFocus(variant, state, yaw, pitch);
    yaw = ToolYaw(next);
    if (!follower.Goes(next)) return false;
  }
  return true;
}

robot::Posture RandomPosture(const robot::Arm& arm, core::Rng& rng) {
  robot::Posture posture(arm.size());
  for (Eigen::Index j = 0; j < posture.size(); ++j) {
    const robot::ArmJoint& joint = arm.joints[static_cast<size_t>(j)];
    posture[j] = core::Uniform(rng, joint.lower, joint.upper);
  }
  return posture;
}

}  // namespace

double ToolYaw(const Isometry3d& world_from_tool) {
  const Vector3d across = world_from_tool.linear().col(1);
  return std::atan2(across.y(), across.x());
}

Isometry3d ToolAtFocus(const SkillVariant& variant, const tasks::SceneState& state, double tool_yaw,
                       double pitch) {
  const Focus& focus = *variant.focus;
  Isometry3d tool = Isometry3d::Identity();
  if (focus.joint >= 0) {
    tool = ToolAtJoint(variant.model, state, focus);
    // The hand is the same turned by half about its own axis: the nearer one.
    const Vector3d across = tool.linear().col(1);
    if (across.x() * std::cos(tool_yaw) + across.y() * std::sin(tool_yaw) < 0.0) {
      tool.linear().leftCols<2>() *= -1.0;
    }
  } else {
    const Isometry3d& root = state.roots[static_cast<size_t>(focus.thing)];
    const double yaw =
        ThinDirection(variant.model.things[static_cast<size_t>(focus.thing)], root, tool_yaw);
    const Vector3d across(std::cos(yaw), std::sin(yaw), 0.0), down(0.0, 0.0, -1.0);
    tool.linear() << across.cross(down), across, down;
    tool.translation() = root * focus.link_from_tool.translation();
  }
  tool.rotate(Eigen::AngleAxisd(pitch, Vector3d::UnitY()));
  return tool;
}

std::optional<ReachPlan> PlanReach(const Skill& skill, const SkillVariant& variant,
                                   const tasks::SceneState& state, const robot::Posture& from,
                                   core::Rng& rng) {
  const Isometry3d& world_from_base = variant.subtask.start.world_from_robot;
  const double yaw = ToolYaw(world_from_base * robot::ForwardKinematics(skill.robot->arm, from));
  for (const double pitch : kPitches) {
    const Isometry3d tool = ToolAtFocus(variant, state, yaw, pitch);
    robot::Posture start = from;
    for (int i = 0; i < kPostures; ++i) {
      const robot::PoseSolution found =
          skill.kinematics->Solve(world_from_base.inverse() * tool, start, rng);
      if (!found.reached) break;
      if (Works(skill, variant, state, tool, pitch, found.q)) return ReachPlan{pitch, found.q};
      start = RandomPosture(skill.robot->arm, rng);
    }
  }
  return std::nullopt;
}

}  // namespace simwright::rl
