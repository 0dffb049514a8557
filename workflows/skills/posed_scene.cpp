#include "workflows/skills/posed_scene.h"

#include <algorithm>

#include "assets/primitive_meshes.h"
#include "core/error.h"

namespace simwright::workflows {
namespace {

using Eigen::Isometry3d;

const Eigen::Vector4f kRobotColor(0.90f, 0.91f, 0.93f, 1.0f);
const Eigen::Vector4f kFingerColor(0.35f, 0.36f, 0.40f, 1.0f);
const Eigen::Vector4f kObjectColor(0.75f, 0.72f, 0.66f, 1.0f);
const Eigen::Vector4f kFloorColor(0.62f, 0.64f, 0.66f, 1.0f);
constexpr double kFloorSide = 12.0;  // m

}  // namespace

PosedScene::PosedScene(const robot::RobotModel& robot, const skills::SkillVariant& variant)
    : robot_(robot), variant_(variant) {
  const std::vector<int>& fingers = robot.gripper.links;
  for (const assets::LinkVisual& visual : assets::LinkVisuals(robot.urdf)) {
    const bool finger = std::find(fingers.begin(), fingers.end(), visual.link) != fingers.end();
    Add(visual, finger ? kFingerColor : kRobotColor, -1);
  }
  for (const int object : variant.placed) {
    for (const assets::LinkVisual& visual : variant.visuals[static_cast<size_t>(object)]) {
      Add(visual, kObjectColor, object);
    }
  }
  core::TriangleMesh floor = assets::BoxMesh({kFloorSide, kFloorSide, 0.02});
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(0.0, 0.0, -0.0105)), &floor);
  floor_ = assets::InOneColor(std::move(floor), kFloorColor);
}

void PosedScene::Add(const assets::LinkVisual& visual, const Eigen::Vector4f& color, int object) {
  try {
    core::TexturedMesh seen = assets::ReadVisual(visual, color);
    if (!seen.mesh.empty()) pieces_.push_back({std::move(seen), object, visual.link});
  } catch (const core::Error&) {
    return;  // only the picture lacks it
  }
}

std::vector<Isometry3d> PosedScene::Poses(const RecordedMoment& moment) const {
  const std::vector<Isometry3d> robot = robot_.LinkPoses(moment.arm, moment.leader);
  std::vector<std::vector<Isometry3d>> objects(variant_.model.objects.size());
  for (const int object : variant_.placed) {
    const auto t = static_cast<size_t>(object);
    objects[t] = tasks::LinkPosesOf(variant_.model.objects[t], moment.state.joints[t]);
  }
  std::vector<Isometry3d> poses;
  for (const Piece& piece : pieces_) {
    const auto link = static_cast<size_t>(piece.link);
    if (piece.object < 0) {
      poses.push_back(variant_.subtask.start.world_from_robot * robot[link]);
    } else {
      const auto t = static_cast<size_t>(piece.object);
      poses.push_back(moment.state.roots[t] * objects[t][link]);
    }
  }
  return poses;
}

void PosedScene::Place(const RecordedMoment& moment, render::Scene* scene) const {
  const std::vector<Isometry3d> poses = Poses(moment);
  for (size_t i = 0; i < pieces_.size(); ++i) scene->Add(&pieces_[i].mesh, poses[i]);
  scene->Add(&floor_);
  scene->Commit();
}

Eigen::AlignedBox3d PosedScene::Bounds(const RecordedMoment& moment) const {
  const std::vector<Isometry3d> poses = Poses(moment);
  Eigen::AlignedBox3d bounds;
  for (size_t i = 0; i < pieces_.size(); ++i) {
    for (const Eigen::Vector3d& vertex : pieces_[i].mesh.mesh.vertices) {
      bounds.extend(poses[i] * vertex);
    }
  }
  return bounds;
}

}  // namespace simwright::workflows
