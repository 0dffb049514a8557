#include "rl/arm_clearance.h"

#include "assets/joint_poses.h"
#include "rl/hand_clearance.h"

namespace simwright::rl {
namespace {

constexpr double kTouching = 0.001;  // m; in a board no point is deeper than half of its thickness

// world_from_link of the robot's links. (urdf.links)
std::vector<Eigen::Isometry3d> RobotPoses(const robot::RobotModel& robot,
                                          const Eigen::Isometry3d& world_from_robot,
                                          const robot::Posture& arm) {
  assets::JointPositions positions;
  for (Eigen::Index j = 0; j < arm.size(); ++j) {
    const auto joint = static_cast<size_t>(robot.arm_joints[static_cast<size_t>(j)]);
    positions[robot.urdf.joints[joint].name] = arm[j];
  }
  if (!robot.gripper.joints.empty()) {
    const auto leader = static_cast<size_t>(robot.gripper.joints.front());
    positions[robot.urdf.joints[leader].name] = robot.gripper.open;
  }
  std::vector<Eigen::Isometry3d> poses = assets::LinkPoses(robot.urdf, positions);
  for (Eigen::Isometry3d& pose : poses) pose = world_from_robot * pose;
  return poses;
}

}  // namespace

bool IsArmClear(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
                const robot::Posture& arm, int held) {
  const std::vector<Eigen::Isometry3d> robot =
      RobotPoses(*skill.robot, variant.subtask.start.world_from_robot, arm);
  for (const int thing : variant.placed) {
    if (thing == held) continue;
    const auto t = static_cast<size_t>(thing);
    const std::vector<Eigen::Isometry3d> poses = BodyPoses(
        variant.bodies[t]->body(), variant.model.things[t], state.roots[t], state.joints[t]);
    for (size_t l = 0; l < robot.size(); ++l) {
      const SurfacePoints& surface = skill.robot_surface[l];
      if (DeepestInBody(surface, robot[l], variant.solids[t], poses) > kTouching) return false;
    }
  }
  return true;
}

}  // namespace simwright::rl
