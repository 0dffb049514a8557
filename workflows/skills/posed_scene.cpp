#include "workflows/skills/posed_scene.h"

#include <algorithm>

#include "assets/mesh_import.h"
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

core::TexturedMesh InOneColor(core::TriangleMesh mesh, const Eigen::Vector4f& color) {
  core::TexturedMesh colored;
  colored.mesh = std::move(mesh);
  colored.triangle_material.assign(colored.mesh.triangles.size(), 0);
  colored.materials.push_back({"plain", color, -1});
  return colored;
}

// Returns a visual in its link's frame with the file's own materials, unless the URDF gives a
// colour and it has no texture.
core::TexturedMesh VisualMesh(const assets::UrdfShape& shape, const Eigen::Vector4f& color) {
  if (shape.file.empty()) return InOneColor(shape.mesh, shape.color.value_or(color));
  core::TexturedMesh seen = assets::ReadMesh(shape.file);
  core::Transform(shape.link_from_file, &seen.mesh);
  if (seen.textures.empty() && shape.color) {
    for (core::Material& material : seen.materials) material.base_color = *shape.color;
  }
  return seen;
}

}  // namespace

PosedScene::PosedScene(const robot::RobotModel& robot, const skills::SkillVariant& variant,
                       const std::vector<tasks::TaskAsset>& assets)
    : robot_(robot), variant_(variant) {
  for (size_t i = 0; i < robot.urdf.links.size(); ++i) {
    const std::vector<int>& fingers = robot.gripper.links;
    const bool finger =
        std::find(fingers.begin(), fingers.end(), static_cast<int>(i)) != fingers.end();
    AddLink(robot.urdf.links[i], finger ? kFingerColor : kRobotColor, -1, static_cast<int>(i));
  }
  for (const int object : variant.placed) {
    const tasks::ArticulatedObject& known = variant.model.objects[static_cast<size_t>(object)];
    for (const tasks::TaskAsset& asset : assets) {
      if (asset.name != known.name) continue;
      for (const assets::UrdfLink& link : assets::ReadSemanticModel(asset.path).model.links) {
        AddLink(link, kObjectColor, object, known.FindLink(link.name));
      }
    }
  }
  core::TriangleMesh floor = assets::BoxMesh({kFloorSide, kFloorSide, 0.02});
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(0.0, 0.0, -0.0105)), &floor);
  floor_ = InOneColor(std::move(floor), kFloorColor);
}

void PosedScene::AddLink(const assets::UrdfLink& link, const Eigen::Vector4f& color, int object,
                         int index) {
  const bool drawn = !link.visuals.empty();
  for (const assets::UrdfShape& shape : drawn ? link.visuals : link.collisions) {
    try {
      core::TexturedMesh seen = VisualMesh(shape, color);
      if (!seen.mesh.empty()) pieces_.push_back({std::move(seen), object, index});
    } catch (const core::Error&) {
      continue;  // only the picture lacks it
    }
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
