#include "workflows/skills/robot_visuals.h"

#include <algorithm>

#include "assets/link_visuals.h"
#include "core/error.h"

namespace simwright::workflows {
namespace {

const Eigen::Vector4f kArmColor(0.90f, 0.91f, 0.93f, 1.0f);
const Eigen::Vector4f kFingertipColor(0.35f, 0.36f, 0.40f, 1.0f);

}  // namespace

RobotVisuals::RobotVisuals(const robot::RobotModel& robot) : robot_(robot) {
  const std::vector<int>& fingers = robot.gripper.links;
  for (const assets::LinkVisual& visual : assets::LinkVisuals(robot.urdf)) {
    const bool finger = std::find(fingers.begin(), fingers.end(), visual.link) != fingers.end();
    try {
      core::TexturedMesh seen = assets::ReadVisual(visual, finger ? kFingertipColor : kArmColor);
      if (!seen.mesh.empty()) {
        pieces_.push_back({std::move(seen), static_cast<size_t>(visual.link)});
      }
    } catch (const core::Error&) {
      continue;  // only the picture lacks it
    }
  }
}

void RobotVisuals::Place(const Eigen::VectorXd& arm, double leader,
                         const Eigen::Isometry3d& world_from_robot, render::Scene* scene) const {
  const std::vector<Eigen::Isometry3d> poses = robot_.LinkPoses(arm, leader);
  for (const Piece& piece : pieces_) scene->Add(&piece.mesh, world_from_robot * poses[piece.link]);
}

}  // namespace simwright::workflows
