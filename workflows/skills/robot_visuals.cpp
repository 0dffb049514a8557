#include "workflows/skills/robot_visuals.h"

#include <algorithm>

#include "assets/mesh_import.h"
#include "core/error.h"

namespace simwright::workflows {
namespace {

const Eigen::Vector4f kArmColor(0.90f, 0.91f, 0.93f, 1.0f);
const Eigen::Vector4f kFingertipColor(0.35f, 0.36f, 0.40f, 1.0f);

core::TexturedMesh VisualOf(const assets::UrdfShape& shape, const Eigen::Vector4f& color) {
  core::TexturedMesh seen;
  if (!shape.file.empty()) {
    seen = assets::ReadMesh(shape.file);
    core::Transform(shape.link_from_file, &seen.mesh);
    return seen;
  }
  seen.mesh = shape.mesh;
  seen.triangle_material.assign(seen.mesh.triangles.size(), 0);
  seen.materials.push_back({"plain", shape.color.value_or(color), -1});
  return seen;
}

}  // namespace

RobotVisuals::RobotVisuals(const robot::RobotModel& robot) : robot_(robot) {
  for (size_t i = 0; i < robot.urdf.links.size(); ++i) {
    const assets::UrdfLink& link = robot.urdf.links[i];
    const std::vector<int>& fingers = robot.gripper.links;
    const bool finger =
        std::find(fingers.begin(), fingers.end(), static_cast<int>(i)) != fingers.end();
    for (const assets::UrdfShape& shape : link.visuals.empty() ? link.collisions : link.visuals) {
      try {
        core::TexturedMesh seen = VisualOf(shape, finger ? kFingertipColor : kArmColor);
        if (!seen.mesh.empty()) pieces_.push_back({std::move(seen), i});
      } catch (const core::Error&) {
        continue;  // only the picture lacks it
      }
    }
  }
}

void RobotVisuals::Place(const Eigen::VectorXd& arm, double leader,
                         const Eigen::Isometry3d& world_from_robot, render::Scene* scene) const {
  const std::vector<Eigen::Isometry3d> poses = robot_.LinkPoses(arm, leader);
  for (const Piece& piece : pieces_) scene->Add(&piece.mesh, world_from_robot * poses[piece.link]);
}

}  // namespace simwright::workflows
